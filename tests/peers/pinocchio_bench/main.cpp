// Times Pinocchio's dynamics and Jacobians on given states, and writes its results.
//
// usage: pinocchio_bench ROBOT STATES RESULTS
// ROBOT: one line per body: name of its joint, index of the parent's line, axis (x, y or z), origin in the parent's
// frame, mass, centre of mass, moments xx xy yy xz yz zz about it. The base comes first. No URDF: the wheel's parser is
// compiled for other vector registers than this program and hands over memory aligned for those.
// STATES: names of the joints on one line, names of the joints that move the feet on the next, then one line of q, v,
// force per state in the order of the joints.
// RESULTS: per state M (lower triangle by rows), h, forward dynamics, in the same order, as raw doubles.
// Prints: name, then for the time of one call in us the minimum, median, and 90th percentile over batches.
// Steps of the recursions have up to seven arguments.
#define BOOST_FUSION_INVOKE_MAX_ARITY 10
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/center-of-mass.hpp>
#include <pinocchio/algorithm/cholesky.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <vector>

namespace pin = pinocchio;
using Eigen::VectorXd;

struct State { VectorXd q, v, force; };

constexpr int batches = 301;

template <class Call> std::vector<double> times(const std::vector<State>& states, Call call) {
  std::vector<double> us;
  for (int b = -20; b < batches; ++b) {
    auto start = std::chrono::steady_clock::now();
    for (const State& s : states) call(s);
    std::chrono::duration<double, std::micro> d = std::chrono::steady_clock::now() - start;
    if (b >= 0) us.push_back(d.count() / states.size());
  }
  std::sort(us.begin(), us.end());
  return us;
}

void print(const char* name, const std::vector<double>& us) {
  std::printf("%s %.4f %.4f %.4f\n", name, us[0], us[batches / 2], us[batches * 9 / 10]);
}

template <class Call> void measure(const char* name, const std::vector<State>& states, Call call) {
  print(name, times(states, call));
}

// In both of Pinocchio's conventions, of which the faster one counts.
template <class Call> void measure_both(const char* name, const std::vector<State>& states, Call call) {
  const auto local = times(states, [&](const State& s) { call(s, pin::Convention::LOCAL); });
  const auto world = times(states, [&](const State& s) { call(s, pin::Convention::WORLD); });
  std::fprintf(stderr, "%s: median %.3f us LOCAL, %.3f us WORLD\n", name, local[batches / 2], world[batches / 2]);
  print(name, local[batches / 2] <= world[batches / 2] ? local : world);
}

pin::Model read(const char* path) {
  pin::Model model;
  std::ifstream in(path);
  std::vector<pin::JointIndex> joints;
  std::string name;
  char axis;
  for (int parent; in >> name >> parent >> axis;) {
    Eigen::Vector3d r, c;
    double m, i[6];
    in >> r[0] >> r[1] >> r[2] >> m >> c[0] >> c[1] >> c[2];
    for (double& x : i) in >> x;
    const pin::SE3 at(Eigen::Matrix3d::Identity(), r);
    if (joints.empty()) joints.push_back(model.addJoint(0, pin::JointModelFreeFlyer(), at, name));
    else if (axis == 'x') joints.push_back(model.addJoint(joints[parent], pin::JointModelRX(), at, name));
    else if (axis == 'y') joints.push_back(model.addJoint(joints[parent], pin::JointModelRY(), at, name));
    else joints.push_back(model.addJoint(joints[parent], pin::JointModelRZ(), at, name));
    model.appendBodyToJoint(joints.back(), pin::Inertia(m, c, pin::Symmetric3(i[0], i[1], i[2], i[3], i[4], i[5])));
  }
  return model;
}

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "usage: pinocchio_bench ROBOT STATES RESULTS\n"), 2;
  const pin::Model model = read(argv[1]);
  pin::Data data(model);

  std::ifstream in(argv[2]);
  std::string line, name;
  std::getline(in, line);
  std::vector<int> at = {0, 1, 2, 3, 4, 5};  // their v index of our v index
  for (std::istringstream names(line); names >> name;) at.push_back(model.joints[model.getJointId(name)].idx_v());
  std::vector<pin::JointIndex> feet;
  std::getline(in, line);
  for (std::istringstream names(line); names >> name;) feet.push_back(model.getJointId(name));
  const int nv = model.nv;
  if (int(at.size()) != nv || model.nq != nv + 1) return std::fprintf(stderr, "joints do not match\n"), 1;
  std::vector<State> states;
  while (std::getline(in, line)) {
    std::istringstream numbers(line);
    State s{VectorXd(nv + 1), VectorXd(nv), VectorXd(nv)};
    for (int k = 0; k < 7; ++k) numbers >> s.q[k];
    for (int k = 6; k < nv; ++k) numbers >> s.q[at[k] + 1];
    for (int k = 0; k < nv; ++k) numbers >> s.v[at[k]];
    for (int k = 0; k < nv; ++k) numbers >> s.force[at[k]];
    states.push_back(s);
  }

  measure_both("mass_matrix", states, [&](const State& s, pin::Convention c) { pin::crba(model, data, s.q, c); });
  measure("inverse_dynamics", states, [&](const State& s) { pin::rnea(model, data, s.q, s.v, s.force); });
  measure("nonlinear_terms", states, [&](const State& s) { pin::nonLinearEffects(model, data, s.q, s.v); });
  VectorXd x(nv);
  measure_both("forward_matrix", states, [&](const State& s, pin::Convention c) {
    pin::crba(model, data, s.q, c);
    x = s.force - pin::nonLinearEffects(model, data, s.q, s.v);
    pin::cholesky::decompose(model, data);
    pin::cholesky::solve(model, data, x);
  });
  measure_both("forward_articulated", states, [&](const State& s, pin::Convention c) {
    pin::aba(model, data, s.q, s.v, s.force, c);
  });
  pin::Data::Matrix6x jacobian = pin::Data::Matrix6x::Zero(6, nv);
  measure("foot_jacobians", states, [&](const State& s) {
    pin::computeJointJacobians(model, data, s.q);
    for (pin::JointIndex foot : feet)
      pin::getJointJacobian(model, data, foot, pin::LOCAL_WORLD_ALIGNED, jacobian.setZero());
  });
  measure("cog_jacobian", states, [&](const State& s) { pin::jacobianCenterOfMass(model, data, s.q, false); });

  std::ofstream out(argv[3], std::ios::binary);
  auto put = [&](double d) { out.write(reinterpret_cast<const char*>(&d), sizeof d); };
  for (const State& s : states) {
    pin::crba(model, data, s.q);
    for (int i = 0; i < nv; ++i)
      for (int j = 0; j <= i; ++j) put(data.M(std::min(at[i], at[j]), std::max(at[i], at[j])));
    pin::nonLinearEffects(model, data, s.q, s.v);
    for (int i = 0; i < nv; ++i) put(data.nle[at[i]]);
    pin::aba(model, data, s.q, s.v, s.force);
    for (int i = 0; i < nv; ++i) put(data.ddq[at[i]]);
  }
  return out.good() ? 0 : 1;
}
