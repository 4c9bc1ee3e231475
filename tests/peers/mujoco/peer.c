// Simulates one scene in MuJoCo, through its C interface and on one thread, and prints one line of JSON.
//
// usage: peer MODEL.mjb STATE.txt KEY=VALUE...
//
// | key        | what                                                                          | unless told |
// |------------|-------------------------------------------------------------------------------|-------------|
// | scene      | dynamics: mass matrix and nonlinear terms of the state, no motion             |             |
// |            | flight: no contact, no servos (also a chain that falls)                       |             |
// |            | settle: servos hold the joints of the state, the robot drops onto its feet    |             |
// |            | stand: the same, timed from `before` on                                       |             |
// |            | incline: block on a plane                                                     |             |
// | integrator | Euler (semi-implicit), RK4, implicit, implicitfast, discrete                  | Euler       |
// | cone       | elliptic, pyramidal                                                           | the model's |
// | solver     | PGS, CG, Newton                                                               | the model's |
// | impratio   | stiffness of friction over that of the normal direction                       | the model's |
// | noslip     | iterations of the solver that takes creep back                                | the model's |
// | step       | [s]                                                                           | 1e-3        |
// | duration   | [s] simulated, and timed                                                      | 1           |
// | before     | [s] simulated before that, and not timed                                      | 0           |
// | runs       | of the same motion; the time is their median                                  | 5           |
// | slope, direction, friction | incline: [deg], [deg] of the line of fall from x to y, [1]    | 20, 0, 0.8  |
//
// States go in and out in our coordinates: q = base position, base quaternion (x, y, z, w), joints; v = velocity and
// angular velocity of the base in the base frame, joint speeds (crates/multibody, Model). MuJoCo's base velocity has
// world axes, its quaternion begins with w. With T = diag(R, 1): v_mujoco = T v, M = T' M_mujoco T.
//
// The time is that of the thread on the processor, so that other programs count little. Numbers that are not finite, or
// larger than MuJoCo's limits, end a run: "diverged" tells when, and the results that would be none are null.
#include <mujoco/mujoco.h>

#include <stdio.h>
#include <string.h>
#include <time.h>

#define DEGREE (mjPI / 180)

enum { LARGEST = 64, MOST_RUNS = 101 };

struct options {
  const char* scene;
  int runs;
  double step, duration, before, slope, direction, friction; // angles in degrees
};

// State in our coordinates; joints in the order of the file.
struct state {
  int n;
  char name[LARGEST][48];
  double q[7 + LARGEST], v[6 + LARGEST];
};

// What a motion showed on the way.
struct seen {
  double peak_normal, lowest, impulse, penetration, drift, middle_speed[3];
  int contacts, rows;
};

// In the order of mjtIntegrator, mjtCone, mjtSolver.
static const char* const integrators[] = {"Euler", "RK4", "implicit", "implicitfast", "discrete"};
static const char* const cones[] = {"pyramidal", "elliptic"};
static const char* const solvers[] = {"PGS", "CG", "Newton"};

static void fail(const char* what, const char* which) {
  fprintf(stderr, "peer: %s: %s\n", what, which);
  exit(1);
}

static void report(const mjLogMessage* message) {
  if (message->level == mjLOG_ERROR) fail("MuJoCo", message->subject);
}

// --- In -----------------------------------------------------------------------------------------------------------

static int choice(const char* key, const char* value, const char* const names[], int count) {
  for (int i = 0; i < count; i++)
    if (!strcmp(value, names[i])) return i;
  fail(key, value);
  return -1;
}

static double number(const char* key, const char* value) {
  char* end;
  const double x = strtod(value, &end);
  if (end == value || *end || !isfinite(x)) fail(key, value);
  return x;
}

static void set(struct options* o, mjOption* opt, const char* argument) {
  static const char* const scenes[] = {"dynamics", "flight", "settle", "stand", "incline"};
  char key[32];
  const char* value = strchr(argument, '=');
  if (!value || value - argument >= (long)sizeof key) fail("not KEY=VALUE", argument);
  snprintf(key, sizeof key, "%.*s", (int)(value - argument), argument);
  value++;
  if (!strcmp(key, "scene")) o->scene = scenes[choice(key, value, scenes, 5)];
  else if (!strcmp(key, "integrator")) opt->integrator = choice(key, value, integrators, 5);
  else if (!strcmp(key, "cone")) opt->cone = choice(key, value, cones, 2);
  else if (!strcmp(key, "solver")) opt->solver = choice(key, value, solvers, 3);
  else if (!strcmp(key, "impratio")) opt->impratio = number(key, value);
  else if (!strcmp(key, "noslip")) opt->noslip_iterations = (int)number(key, value);
  else if (!strcmp(key, "step")) o->step = number(key, value);
  else if (!strcmp(key, "duration")) o->duration = number(key, value);
  else if (!strcmp(key, "before")) o->before = number(key, value);
  else if (!strcmp(key, "runs")) o->runs = (int)number(key, value);
  else if (!strcmp(key, "slope")) o->slope = number(key, value);
  else if (!strcmp(key, "direction")) o->direction = number(key, value);
  else if (!strcmp(key, "friction")) o->friction = number(key, value);
  else fail("unknown key", key);
}

static int numbers(const char* line, double* x, int most) {
  int n = 0;
  char* end;
  for (double y = strtod(line, &end); end != line && n < most; y = strtod(line, &end)) x[n++] = y, line = end;
  return n;
}

static void read_state(const char* path, struct state* s) {
  FILE* file = fopen(path, "r");
  if (!file) fail("cannot open", path);
  static char line[1 << 14];
  int nq = 0, nv = 0;
  while (fgets(line, sizeof line, file)) {
    if (!strncmp(line, "joints", 6)) {
      for (char* word = strtok(line + 6, " \n"); word && s->n < LARGEST; word = strtok(NULL, " \n"))
        snprintf(s->name[s->n++], sizeof s->name[0], "%s", word);
    } else if (line[0] == 'q') nq = numbers(line + 1, s->q, 7 + LARGEST);
    else if (line[0] == 'v') nv = numbers(line + 1, s->v, 6 + LARGEST);
  }
  fclose(file);
  if (nq != 7 + s->n || nv != 6 + s->n) fail("q must have 7 + n, v 6 + n numbers", path);
}

// --- Our coordinates and MuJoCo's -----------------------------------------------------------------------------------

static int is_free(const mjModel* m) { return m->njnt > 0 && m->jnt_type[0] == mjJNT_FREE; }

static int joint(const mjModel* m, const struct state* s, int k) {
  const int id = mj_name2id(m, mjOBJ_JOINT, s->name[k]);
  if (id < 0) fail("the model has no joint", s->name[k]);
  return id;
}

static void put(const mjModel* m, mjData* d, const struct state* s) {
  mj_resetData(m, d);
  if (is_free(m)) {
    const double quaternion[4] = {s->q[6], s->q[3], s->q[4], s->q[5]};
    mju_copy3(d->qpos, s->q);
    mju_copy4(d->qpos + 3, quaternion);
    mju_rotVecQuat(d->qvel, s->v, quaternion);
    mju_copy3(d->qvel + 3, s->v + 3);
  }
  for (int k = 0; k < s->n; k++) {
    const int id = joint(m, s, k);
    d->qpos[m->jnt_qposadr[id]] = s->q[7 + k];
    d->qvel[m->jnt_dofadr[id]] = s->v[6 + k];
  }
  for (int a = 0; a < m->nu; a++) d->ctrl[a] = d->qpos[m->jnt_qposadr[m->actuator_trnid[2 * a]]];
}

static void get(const mjModel* m, const mjData* d, struct state* s) {
  if (is_free(m)) {
    const mjtNum* quaternion = d->qpos + 3;
    mjtNum back[4];
    mju_negQuat(back, quaternion);
    mju_copy3(s->q, d->qpos);
    for (int i = 0; i < 4; i++) s->q[3 + i] = quaternion[(i + 1) % 4];
    mju_rotVecQuat(s->v, d->qvel, back);
    mju_copy3(s->v + 3, d->qvel + 3);
  }
  for (int k = 0; k < s->n; k++) {
    const int id = joint(m, s, k);
    s->q[7 + k] = d->qpos[m->jnt_qposadr[id]];
    s->v[6 + k] = d->qvel[m->jnt_dofadr[id]];
  }
}

// --- Motion ---------------------------------------------------------------------------------------------------------

static int diverged(const mjData* d) {
  return d->warning[mjWARN_BADQPOS].number + d->warning[mjWARN_BADQVEL].number + d->warning[mjWARN_BADQACC].number;
}

static long steps(double duration, double step) { return (long)floor(duration / step + 0.5); }

// Steps done until the end or until the numbers are lost.
static long move(const mjModel* m, mjData* d, long count) {
  long k = 0;
  for (; k < count && !diverged(d); k++) mj_step(m, d);
  return k;
}

// Sum of the forces of the contacts on the robot's bodies, in the world; with `side` only those of its feet's points.
static void contact_force(const mjModel* m, const mjData* d, const char* side, double sum[3]) {
  mju_zero3(sum);
  for (int c = 0; c < d->ncon; c++) {
    const char* name = mj_id2name(m, mjOBJ_GEOM, d->contact[c].geom[1]);
    if (side && (!name || strncmp(name, side, strlen(side)))) continue;
    mjtNum wrench[6], world[3];
    mj_contactForce(m, d, c, wrench);
    mju_mulMatTVec(world, d->contact[c].frame, wrench, 3, 3);
    mju_addTo3(sum, world);
  }
}

// The same motion once more, slowly, with an eye on forces; not timed.
static void watch(const mjModel* m, mjData* d, long count, double step, struct seen* seen) {
  if (!is_free(m)) return;
  const double x = d->qpos[0], y = d->qpos[1];
  seen->lowest = d->qpos[2];
  for (long k = 0; k < count && !diverged(d); k++) {
    double f[3];
    if (k == count / 2) mju_copy3(seen->middle_speed, d->qvel);
    mj_step(m, d);
    contact_force(m, d, NULL, f);
    seen->peak_normal = mju_max(seen->peak_normal, f[2]);
    seen->impulse += f[2] * step;
    seen->lowest = mju_min(seen->lowest, d->qpos[2]);
  }
  for (int c = 0; c < d->ncon; c++) seen->penetration -= d->contact[c].dist / d->ncon;
  seen->drift = hypot(d->qpos[0] - x, d->qpos[1] - y);
  seen->contacts = d->ncon;
  seen->rows = d->nefc;
}

static double cpu_now(void) {
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static int ascending(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

// --- Out ------------------------------------------------------------------------------------------------------------

static void print_number(double x) { isfinite(x) ? printf("%.17g", x) : printf("null"); }

static void print_numbers(const char* name, const double* x, int n) {
  printf(",\"%s\":[", name);
  for (int i = 0; i < n; i++) {
    if (i) printf(",");
    print_number(x[i]);
  }
  printf("]");
}

static void print_value(const char* name, double x) {
  printf(",\"%s\":", name);
  print_number(x);
}

static void print_state(const struct state* s) {
  double all[13 + 2 * LARGEST];
  mju_copy(all, s->q, 7 + s->n);
  mju_copy(all + 7 + s->n, s->v, 6 + s->n);
  printf(",\"joints\":[");
  for (int k = 0; k < s->n; k++) printf("%s\"%s\"", k ? "," : "", s->name[k]);
  printf("]");
  print_numbers("state", all, 13 + 2 * s->n);
}

static double energy(const mjModel* m, mjData* d) {
  mj_forward(m, d);
  mj_energyPos(m, d);
  mj_energyVel(m, d);
  return d->energy[0] + d->energy[1];
}

// Momentum, and angular momentum about the centre of gravity, in the world.
static void print_momentum(const mjModel* m, mjData* d) {
  mjtNum p[3];
  mj_subtreeVel(m, d);
  mju_scl3(p, d->subtree_linvel, m->body_subtreemass[0]);
  print_numbers("momentum", p, 3);
  print_numbers("angular_momentum", d->subtree_angmom, 3);
}

// M = T' M_mujoco T and h = T' (h_mujoco + M_mujoco dT/dt v), rows and columns in our order.
static void print_dynamics(const mjModel* m, const struct state* s) {
  const int nv = m->nv;
  mjData* d = mj_makeData(m);
  static double mass[LARGEST * LARGEST], t[LARGEST * LARGEST], mt[LARGEST * LARGEST], h[LARGEST], ours[LARGEST];
  put(m, d, s);
  mj_forward(m, d);
  mj_fullM(m, d, mass);
  mju_copy(h, d->qfrc_bias, nv);
  mju_zero(t, nv * nv);
  if (is_free(m)) {
    mjtNum r[9], turning[3], rate[LARGEST] = {0}, force[LARGEST];
    mju_quat2Mat(r, d->qpos + 3);
    for (int i = 0; i < 3; i++) {
      mju_copy3(t + i * nv, r + 3 * i);
      t[(3 + i) * nv + 3 + i] = 1;
    }
    mju_cross(turning, s->v + 3, s->v);
    mju_mulMatVec3(rate, r, turning);
    mju_mulMatVec(force, mass, rate, nv, nv);
    mju_addTo(h, force, nv);
  }
  const int first = is_free(m) ? 6 : 0;
  for (int k = 0; k < s->n; k++) t[m->jnt_dofadr[joint(m, s, k)] * nv + first + k] = 1;
  mju_mulMatMat(mt, mass, t, nv, nv, nv);
  mju_mulMatTMat(mass, t, mt, nv, nv, nv);
  mju_mulMatTVec(ours, t, h, nv, nv);
  print_numbers("mass_matrix", mass, nv * nv);
  print_numbers("nonlinear_terms", ours, nv);
  print_value("mass_kg", m->body_subtreemass[0]);
  mj_deleteData(d);
}

static void print_contact(const mjModel* m, const mjData* d, const struct seen* seen, double before_height) {
  double right[3], left[3];
  contact_force(m, d, "right", right);
  contact_force(m, d, "left", left);
  print_numbers("force_right_n", right, 3);
  print_numbers("force_left_n", left, 3);
  print_value("peak_normal_n", seen->peak_normal);
  print_value("impulse_ns", seen->impulse);
  print_value("lowest_m", seen->lowest);
  print_value("sunk_m", before_height - d->qpos[2]);
  print_value("penetration_m", seen->penetration);
  print_value("drift_m", seen->drift);
  printf(",\"contacts\":%d,\"rows\":%d", seen->contacts, seen->rows);
  printf(",\"servo\":{\"stiffness\":%g,\"damping\":%g,\"rotor_inertia\":%g}", m->actuator_gainprm[0],
         -m->actuator_biasprm[2], m->dof_armature[m->nv - 1]);
}

// Along the line of fall and across: speed at the end, acceleration over the second half.
static void print_incline(const mjData* d, const struct options* o, const struct seen* seen) {
  const double c = cos(o->direction * DEGREE), s = sin(o->direction * DEGREE), slope = o->slope * DEGREE;
  const double half = d->time - o->before - steps(o->duration, o->step) / 2 * o->step;
  const double* v = d->qvel;
  const double* w = seen->middle_speed;
  print_value("slope_deg", o->slope);
  print_value("direction_deg", o->direction);
  print_value("friction", o->friction);
  print_value("speed", c * v[0] + s * v[1]);
  print_value("speed_across", c * v[1] - s * v[0]);
  print_value("acceleration", (c * (v[0] - w[0]) + s * (v[1] - w[1])) / half);
  print_value("acceleration_across", (c * (v[1] - w[1]) - s * (v[0] - w[0])) / half);
  print_value("acceleration_exact", mju_max(0, 9.81 * (sin(slope) - o->friction * cos(slope))));
}

// Gravity and friction of the incline; the plane of the model stays level.
static void tilt(mjModel* m, const struct options* o) {
  const double slope = o->slope * DEGREE, direction = o->direction * DEGREE, down = 9.81 * sin(slope);
  const mjtNum g[3] = {down * cos(direction), down * sin(direction), -9.81 * cos(slope)};
  mju_copy3(m->opt.gravity, g);
  for (int k = 0; k < m->ngeom; k++) m->geom_friction[3 * k] = o->friction;
}

static void print_options(const mjModel* m, const struct options* o) {
  printf(",\"integrator\":\"%s\",\"cone\":\"%s\"", integrators[m->opt.integrator], cones[m->opt.cone]);
  printf(",\"solver\":\"%s\",\"impratio\":%g", solvers[m->opt.solver], m->opt.impratio);
  printf(",\"noslip\":%d,\"runs\":%d", m->opt.noslip_iterations, o->runs);
  print_value("step_s", o->step);
  print_value("duration_s", o->duration);
  print_value("before_s", o->before);
}

// Runs the motion, with the time of every run, and prints everything about it.
static void simulate(const mjModel* m, const struct options* o, struct state* s) {
  mjData *start = mj_makeData(m), *d = mj_makeData(m);
  put(m, start, s);
  const double height = s->q[2], energy_start = energy(m, start);
  put(m, start, s);
  const long count = steps(o->duration, o->step), before = move(m, start, steps(o->before, o->step));

  double cpu[MOST_RUNS];
  long done = 0;
  for (int r = 0; r < o->runs; r++) {
    mj_copyData(d, m, start);
    const double begun = cpu_now();
    done = move(m, d, count);
    cpu[r] = (cpu_now() - begun) / (done > 0 ? done : 1);  // of a step, so that a lost run has a cost too
  }
  qsort(cpu, o->runs, sizeof cpu[0], ascending);
  print_options(m, o);
  printf(",\"steps\":%ld", before + done);
  print_value("cpu_s_per_s", cpu[o->runs / 2] / o->step);
  print_value("cpu_s_per_s_min", cpu[0] / o->step);
  print_value("steps_per_s", 1 / cpu[o->runs / 2]);
  print_value("energy_start_j", energy_start);
  printf(",\"diverged\":%s", diverged(d) ? "true" : "false");
  if (diverged(d)) {
    print_value("diverged_at_s", d->time);
    printf(",\"state\":null");
  } else {
    struct seen seen = {0};
    watch(m, start, count, o->step, &seen);
    get(m, d, s);
    print_state(s);
    if (m->nu > 0) print_contact(m, start, &seen, height);
    if (!strcmp(o->scene, "incline")) print_incline(d, o, &seen);
    print_value("energy_j", energy(m, d));
    print_momentum(m, d);
  }
  mj_deleteData(start);
  mj_deleteData(d);
}

int main(int argc, char** argv) {
  if (argc < 4) fail("usage", "peer MODEL.mjb STATE.txt scene=SCENE [KEY=VALUE...]; see peer.c");
  mju_setLogHandler(report);
  mjModel* m = mj_loadModel(argv[1], NULL);
  if (!m || m->nv > LARGEST) fail("no model, or too large", argv[1]);
  struct options o = {NULL, 5, 1e-3, 1, 0, 20, 0, 0.8};
  set(&o, &m->opt, "integrator=Euler");
  for (int i = 3; i < argc; i++) set(&o, &m->opt, argv[i]);
  if (!o.scene) fail("missing", "scene=SCENE");
  if (!(o.step > 0) || !(o.duration >= o.step) || o.before < 0) fail("step, duration, before", "out of range");
  if (o.runs < 1 || o.runs > MOST_RUNS) fail("runs", "1..101");
  m->opt.timestep = o.step;
  if (!strcmp(o.scene, "incline")) tilt(m, &o);

  static struct state s;
  read_state(argv[2], &s);
  printf("{\"peer\":\"mujoco\",\"version\":\"%s\",\"scene\":\"%s\"", mj_versionString(), o.scene);
  if (!strcmp(o.scene, "dynamics")) print_dynamics(m, &s);
  else simulate(m, &o, &s);
  printf("}\n");
  mj_deleteModel(m);
  return 0;
}
