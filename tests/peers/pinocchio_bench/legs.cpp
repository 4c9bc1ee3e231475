// Times Pinocchio's iterative inverse kinematics (its example: Newton with log6, damped) on poses of one leg.
//
// usage: pinocchio_legs FILE: six lines a, alpha, d of Denavit-Hartenberg rows, then lines of six angles, nine entries of a
// rotation by rows and a position: what the angles lead to.
// Prints: name, time of one call in us (minimum, median, 90th percentile over batches), largest error of an angle in rad,
// mean number of iterations, and calls that did not converge.
#define BOOST_FUSION_INVOKE_MAX_ARITY 10
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/spatial.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

namespace pin = pinocchio;
using Eigen::VectorXd;

struct Case { VectorXd q; pin::SE3 target; };

constexpr int batches = 301, most = 100;

struct Solver {
  const pin::Model& model;
  pin::Data data;
  pin::SE3 end;  // frame {6} in the last joint's
  double tolerance, damping;
  Eigen::Matrix<double, 6, 6> jacobian = Eigen::Matrix<double, 6, 6>::Zero();
  long iterations = 0, failures = 0;

  VectorXd solve(VectorXd q, const pin::SE3& target) {
    const pin::SE3 joint = target * end.inverse();
    for (int k = 0; k < most; ++k) {
      pin::computeJointJacobians(model, data, q);
      const pin::SE3 off = data.oMi[6].actInv(joint);
      const Eigen::Matrix<double, 6, 1> error = pin::log6(off).toVector();
      if (error.norm() < tolerance) return q;
      ++iterations;
      pin::getJointJacobian(model, data, 6, pin::LOCAL, jacobian.setZero());
      const Eigen::Matrix<double, 6, 6> j = -pin::Jlog6(off.inverse()) * jacobian;
      Eigen::Matrix<double, 6, 6> square = j * j.transpose();
      square.diagonal().array() += damping;
      q = pin::integrate(model, q, VectorXd(-j.transpose() * square.ldlt().solve(error)));
    }
    ++failures;
    return q;
  }
};

void measure(const char* name, Solver solver, const std::vector<Case>& cases, const std::vector<VectorXd>& guesses) {
  double worst = 0;
  for (size_t k = 0; k < cases.size(); ++k) {
    const long before = solver.failures;
    const VectorXd q = solver.solve(guesses[k], cases[k].target);
    if (solver.failures > before) continue;
    const VectorXd d = q - cases[k].q;
    for (int i = 0; i < 6; ++i) worst = std::max(worst, std::abs(std::remainder(d[i], 2 * M_PI)));
  }
  const double mean = double(solver.iterations) / cases.size();
  const long failures = solver.failures;
  std::vector<double> us;
  double sum = 0;
  for (int b = -20; b < batches; ++b) {
    const auto start = std::chrono::steady_clock::now();
    for (size_t k = 0; k < cases.size(); ++k) sum += solver.solve(guesses[k], cases[k].target)[0];
    const std::chrono::duration<double, std::micro> d = std::chrono::steady_clock::now() - start;
    if (b >= 0) us.push_back(d.count() / cases.size());
  }
  std::sort(us.begin(), us.end());
  std::printf("%-38s%8.3f%8.3f%8.3f%12.1e   %.1f iterations, %ld of %zu not converged\n", name, us[0], us[batches / 2],
              us[batches * 9 / 10], worst, mean, failures, cases.size());
  if (std::isnan(sum)) std::puts("NaN");
}

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: pinocchio_legs FILE\n"), 2;
  std::ifstream in(argv[1]);
  pin::Model model;
  pin::SE3 at = pin::SE3::Identity();
  pin::JointIndex parent = 0;
  for (int k = 0; k < 6; ++k) {
    double a, alpha, d;
    in >> a >> alpha >> d;
    parent = model.addJoint(parent, pin::JointModelRZ(), at, "theta_" + std::to_string(k + 1));
    at = pin::SE3(Eigen::AngleAxisd(alpha, Eigen::Vector3d::UnitX()).toRotationMatrix(), Eigen::Vector3d(a, 0, d));
  }
  std::vector<Case> cases;
  for (;;) {
    Case c{VectorXd(6), pin::SE3::Identity()};
    Eigen::Matrix3d r;
    Eigen::Vector3d p;
    for (int i = 0; i < 6; ++i) in >> c.q[i];
    for (int i = 0; i < 9; ++i) in >> r(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) in >> p[i];
    if (!in) break;
    c.target = pin::SE3(r, p);
    cases.push_back(c);
  }
  std::vector<VectorXd> near, fixed;
  VectorXd bent(6);
  bent << 0, 0.6, -1.2, 0.6, M_PI / 2, 0;
  for (const Case& c : cases) {
    VectorXd q = c.q;
    for (int i = 0; i < 6; ++i) q[i] += i % 2 ? 0.02 : -0.02;
    near.push_back(q);
    fixed.push_back(bent);
  }
  const Solver fine{model, pin::Data(model), at, 1e-10, 0}, loose{model, pin::Data(model), at, 1e-4, 1e-6};
  measure("Pinocchio, from 0.02 rad off, 1e-10", fine, cases, near);
  measure("Pinocchio, from 0.02 rad off, 1e-4", loose, cases, near);
  measure("Pinocchio, from one posture, 1e-10", fine, cases, fixed);
}
