// The state of a scene, and the solves that change it.
//
// The library knows stages of no procedure: the host changes fluid, gravity or constraints and
// calls solve_static(), or step() to go on in time. A solve that fails leaves the state as it was.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "brainshift/constraint_set.hpp"
#include "brainshift/csf.hpp"
#include "brainshift/insertion.hpp"
#include "brainshift/material.hpp"
#include "brainshift/mesh.hpp"
#include "brainshift/types.hpp"

namespace brainshift {

struct Scene {
  Mesh mesh;
  std::vector<std::pair<Index, Material>> materials;   // region -> material; each region once
  Vec3 gravity{0.0, 0.0, -standard_gravity};           // mm/s^2
  std::optional<Csf> csf = std::nullopt;
  ConstraintSet constraints = {};
  // true: the mesh is an image taken under gravity and full CSF, hence in balance with them; loads
  // are differences from that reference, taken at the same deformed positions. false: the mesh is
  // free of load, and gravity and CSF act in full.
  bool balanced_reference = true;
  VolumeStrain volume_strain = VolumeStrain::element;  // nodal: linear tets that do not lock
};

// The same scene on quadratic tets (Mesh::quadratic()); a scene that is quadratic returns as it is.
// Groups of constraints take in the nodes on edges between their nodes: fixed where a face of a tet
// has all corners in the group, tied and opposing where an edge of `nodes` meets one of `partners`,
// obstacles (offset: the mean of the ends', but no more than the node's own distance, and that where
// both ends touch at rest), and supports, whose stiffness moves from the corners of surface faces to their edges, as a constant
// traction does. volume_strain becomes element: quadratic tets need no other.
Scene quadratic(const Scene& scene);

struct Progress {
  double load_factor;    // 0..1 of the present solve
  int iteration;         // Newton iterations so far in this solve
  double residual;       // relative
};

struct StepperOptions {
  double residual_tolerance = 1e-8;         // relative to the largest of the force norms
  double complementarity_tolerance = 1e-8;  // relative
  double correction_tolerance = 4e-11;      // last correction relative to the mesh diameter
  int max_iterations = 60;                  // Newton iterations per load step
  double smallest_load_step = 1.0 / 256.0;  // below it: no equilibrium
  // Threads of a solve, the calling one among them; the others end with it. The results are the
  // same bits for any number.
  int threads = 1;
  // Accepted at the start and of obstacles enabled later, relative to the diameter.
  double initial_penetration = 1e-6;
  // s of wall time since the begin of a solve; the first Newton iteration that ends later stops it
  // with Status::cancelled.
  double time_limit = std::numeric_limits<double>::infinity();
  // Called after every Newton iteration; false stops the solve with Status::cancelled. It must not
  // call the phases of a solve.
  std::function<bool(const Progress&)> progress;
};

// `options` with tolerances for which what a solve leaves open moves no node by more than about
// `accuracy` (mm): docs/charts/speed_accuracy.md has what is left in fact. Throws invalid_argument if it
// is not positive and finite.
StepperOptions within(double accuracy, const Mesh& mesh, StepperOptions options = {});

enum class Status {
  converged,
  no_equilibrium,   // no state in balance was found beyond SolveReport::load_factor
  not_converged,    // iterations ran out
  cancelled
};

const char* to_string(Status status);

// Rayleigh damping of step(), C = alpha M + beta K0. K0 is the stiffness of tissue and supports when
// the step begins (each tet's tangent made positive semidefinite); not of fluid, contact or devices.
struct Damping {
  double alpha = 0.0;  // 1/s, >= 0
  double beta = 0.0;   // s, >= 0
};

// Phases of a solve, see Stepper::begin_static().
enum class StepPhase {
  idle,        // no solve is begun
  begun,       // ready for linearise()
  linearised,  // ready for solve()
  solved,      // ready for update()
  updated,     // ready for linearise() again
  converged,   // ready for accept()
  failed       // the report says why; only reject() is left
};

const char* to_string(StepPhase phase);

// The matrix of the linearised problem of the tissue (supports with it) on what fixed rows and contacts
// leave free, in time with inertia and damping; without devices and the terms of given volumes of fluid,
// which may hold what it does not.
enum class Definiteness {
  not_examined,        // nothing had to be solved, or one factor far from the state has served to the end
  positive_definite,   // where it was factored last, next to the state
  indefinite           // at the state: past a limit point, in buckling, or beyond the range of a law
};

const char* to_string(Definiteness definiteness);

// Certificate of a solve: measured on the state that is left behind; of a solve that did not
// converge (its state is given up), on its last iterate.
struct SolveReport {
  Status status = Status::not_converged;
  // max-norm of unbalanced force / largest of the force norms; in time inertia and damping are among
  // the forces. The norm counts as 1e-6 E D^2 at least (E: of the stiffest tissue, D: the diameter of
  // the mesh); with E of the softest tissue at most 1e-4 is left open, so that the rounding of forces
  // in a hard region does not hide a load on the rest; docs/stability.md.
  double residual = 0.0;
  // max of |min(gap/L, multiplier/F)| over one-sided rows (contacts, stops of a wire with slack), and
  // of what friction exceeds its bound by, over F.
  double complementarity = 0.0;
  double violation = 0.0;         // mm; largest negative gap
  double last_correction = 0.0;   // mm; max-norm of the last Newton step
  double smallest_jacobian = 1.0; // min over tets of det F
  double energy = 0.0;            // uJ stored in tissue, supports and devices
  double kinetic_energy = 0.0;    // uJ of tissue and devices; 0 in statics
  double load_factor = 1.0;       // part of the change of load that is in balance
  int load_steps = 0;
  int iterations = 0;             // Newton
  int factorisations = 0;
  int shifted_factorisations = 0; // those that needed a projected or shifted tangent
  Index active_contacts = 0;
  double tie_gap = 0.0;           // mm; largest transverse gap between track and device
  Index coupling_rows = 0;
  // Of the last problem of the coupling rows that was solved (0 rows and true where there was none):
  // rank of the rows whose force ended between its bounds; false where those rows are dependent, as
  // they are when two rigid devices share a track: their sum is found, and of all the ways to share
  // it the one of least norm. Motions and resultants are unique all the same.
  // Rows held on both sides carry nothing and count in neither.
  Index coupling_rank = 0;
  bool coupling_unique = true;
  double seconds = 0.0, seconds_assembly = 0.0, seconds_factor = 0.0, seconds_line_search = 0.0;
  Definiteness tangent = Definiteness::not_examined;   // of a solve that converged
  // Threads that the BLAS of the linear solver said it may use when the solve began; 0: it does not
  // tell. The same input gives the same bits with 1 only. docs/decisions/threads.md
  int blas_threads = 1;
  std::string message;            // the hint when not converged; else what is to be minded, or empty

  bool converged() const { return status == Status::converged; }
};

// Displacements at points; a point outside the mesh has tet -1 and NaN.
struct PointValues {
  Points values;   // mm
  Indices tet;
};

// How far a solve came that found no balance under its whole load.
struct Farthest {
  double load_factor = 0.0;   // part of the change of load; 0: that of before the solve
  Points displacement;        // N x 3, mm; in balance under that part
};

// How far the mesh may have a state wrong, at points of the rest shape.
struct ErrorEstimate {
  Points correction;        // N x 3, mm: by how much quadratic tets would move the points further
  Eigen::VectorXd error;    // N, mm: its length; NaN outside the mesh
  int iterations = 0;       // of the conjugate gradients
  double seconds = 0.0;
};

// Bytes that a solve holds at its peak besides mesh and state. Known from patterns alone, before any of
// it is taken.
struct MemoryEstimate {
  std::int64_t factor = 0;      // of the tissue's matrix
  // Beside the factor: columns of the path of devices, and of contacts that change while a factor
  // serves, as many as may stand there.
  std::int64_t border = 0;
  std::int64_t compliance = 0;  // of those columns and of coupling rows, W: dense
  std::int64_t rest = 0;        // matrices, what belongs to nodes and tets, work space of all of it
  std::int64_t total = 0;
};

class Stepper {
 public:
  // Throws Error naming the culprit: a region without material, a constraint on a node that is not
  // there, rows that contradict each other, an initial penetration, a fluid above its cavity, ...
  // Whether something holds each body is asked by solve_static() and check_settings() only.
  explicit Stepper(Scene scene, StepperOptions options = {});
  ~Stepper();
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;

  const Mesh& mesh() const;
  const StepperOptions& options() const;

  // Settings, taken up by the next solve.
  Csf& csf();                           // throws invalid_argument if the scene has none
  const Csf& csf() const;
  const ConstraintSet& constraints() const;
  void set_gravity(const Vec3& gravity);
  void enable(ConstraintId id);
  void disable(ConstraintId id);
  void set_damping(const Damping& damping);   // throws not_finite, invalid_argument if negative
  const Damping& damping() const;

  // Devices. Each call takes effect at once (nothing moves) and is balanced by the next solve. Calls
  // with an id throw Error(invalid_argument) for one that is not there, and all that change something
  // while a solve is begun.
  // Inserts a straight, unloaded device: the tissue points that lie on its line now become its
  // track and are held across it from then on; along it they slide. Throws Error(invalid_argument)
  // when the tip is not in tissue or the line leaves it in between.
  DeviceId insert(const BeamDevice& device, const Placement& placement, const Hold& hold = {},
                  const TrackOptions& options = {});
  // Another device on the same track, straight along the placement of the old one, its tip
  // `advance` (mm, >= 0) deeper; the tissue crossed there joins the track. Forces of the track stay
  // (friction as far as the new device can bear it); shape and velocity of the old device go with it.
  // Throws Error(invalid_argument) when the tip would leave the tissue.
  void exchange(DeviceId id, const BeamDevice& device, const Hold& hold, double advance = 0.0);
  // Another hold, in the shape the device has now. The same errors as of insert().
  void set_hold(DeviceId id, const Hold& hold);
  // Other bounds of friction, as of TrackOptions; forces above them fall to them at once.
  // Throws invalid_argument if one is negative or not a number.
  void set_friction(DeviceId id, double shear_bound, double tip_bound = 0.0);
  void remove(DeviceId id);
  DeviceState device(DeviceId id) const;   // of the last good state; throws invalid_argument
  const BeamDevice& device_model(DeviceId id) const;   // what was inserted last

  // Throws what solve_static() would throw for the present settings; changes nothing.
  void check_settings() const;

  // What a solve under the present settings will take. Costs a symbolic analysis, which the next solve
  // need not repeat. Throws linear_solver where the factor is beyond what the solver can number, and for
  // settings that cannot be taken up.
  MemoryEstimate memory_estimate() const;

  // Quasi-static equilibrium under the present settings; leaves all velocities zero. Throws Error
  // for bad settings (rigid_mode, fluid_volume); anything else ends in the report's status.
  SolveReport solve_static();

  // One step of backward Euler over dt (s), with every force taken at its end: v1 = v0 + dt a,
  // u1 = u0 + dt v1, M a = forces(u1) - C v1. The mass of tissue is lumped at the nodes; bodies may
  // float freely. Order one in dt; a step damps the mode of angular frequency w by
  // 1/sqrt(1 + (w dt)^2), and a very long one ends where solve_static() does. Where Newton does not
  // get through, the change of load is let go in parts, as in statics; dt itself is never divided.
  // Positions of 10 mm resolve inertia to the default tolerance for dt above some 1e-5 s; much
  // shorter steps do not converge. Throws invalid_argument where dt is not positive and finite,
  // fluid_volume; anything else ends in the report's status.
  SolveReport step(double dt);

  // The same solves phase by phase; solve_static() and step() are this very loop:
  //
  //   stepper.begin_static();                       // or begin_step(dt)
  //   while (stepper.phase() == StepPhase::begun || stepper.phase() == StepPhase::updated) {
  //     stepper.linearise();                        // tangent at the iterate
  //     stepper.solve();                            // active set, factor, coupling: a direction
  //     stepper.update();                           // line search, new iterate, certificate
  //   }
  //   if (stepper.phase() == StepPhase::converged) {
  //     SolveReport report = stepper.accept();      // the iterate becomes the state
  //   } else {
  //     explain(stepper.progress_report().message);
  //     stepper.reject();                           // the state stays that of before the begin
  //   }
  //
  // A call out of order throws Error(invalid_argument) naming the phases it needs. From begin_... to
  // accept() or reject() the solve works on its own copy: everything below shows the state of before;
  // settings may be changed and count from the next begin; calls that change the state (devices,
  // set_velocity, restore) are refused. reject() may be called at any time in between.
  void begin_static();           // throws as solve_static(); no solve is begun then
  void begin_step(double dt);    // throws as step()
  void linearise();              // may find that the last factor serves again, and do nothing
  void solve();
  // A part of the load that is in balance is followed by the next, one that is not by a smaller one,
  // from the last iterate in balance. Returns the new phase: updated, converged or failed.
  StepPhase update();
  SolveReport accept();
  void reject();
  // An exception out of linearise(), solve() or update() leaves the phase failed.
  StepPhase phase() const;
  // Of the open solve, on its last iterate under the part of the load at hand; status not_converged
  // until the end. Throws invalid_argument when no solve is begun; so does iterate(). References are
  // valid until accept() or reject().
  const SolveReport& progress_report() const;
  const Points& iterate() const;   // N x 3, mm; displacement

  // Of the last solve, which has failed (phase by phase: and was rejected). It is no state of the
  // stepper. One that failed because it would end inside out (SolveReport::smallest_jacobian) has the
  // whole load. Valid until the next begin; throws invalid_argument where the last solve has not failed.
  const Farthest& farthest() const;

  // The state: that of the last solve that converged, under the settings it had.
  const Points& displacement() const;        // N x 3, mm
  const Points& velocity() const;            // N x 3, mm/s; of the last step, 0 after solve_static()
  // Sets the velocity of the tissue nodes (N x 3, mm/s); devices keep theirs. Throws size_mismatch,
  // not_finite.
  void set_velocity(const Points& velocity);
  Points positions() const;                  // N x 3, mm
  Eigen::VectorXd jacobians() const;         // M; det F of each tet
  Eigen::VectorXd fluid_pressure() const;    // N, kPa; 0 where a node is dry or cannot be wetted
  // Nodal forces now (mN), N x 3: of the material, of gravity, of the fluid on the wetted faces
  // (each in full, without the reference taken off).
  Points internal_force() const;
  Points gravity_force() const;
  Points fluid_force() const;
  // Load on the tissue: gravity and fluid, minus the reference load if the scene is balanced (mN).
  Points external_force() const;
  CompartmentState compartment(Index i) const;
  ContactState contact(ConstraintId id) const;

  // Displacement of the material points that lie at `rest_points` in the mesh as given; and the
  // rest points of the material that now lies at `points`.
  PointValues displacement_at(const Points& rest_points) const;
  PointValues rest_points_of(const Points& points) const;

  // The error of the discretisation in the displacement at `rest_points`, of the last static state, for
  // linear tets of either volume strain: what quadratic tets on the same geometry would change, to
  // first order, with the contacts they would have; forces of devices stay what they are. Errors of
  // the geometry, the law and its parameters are not in it. Costs a factorisation of the linear tets
  // and, per change of contacts, tens of products with the quadratic ones' matrix, ten times as large.
  // Throws invalid_argument on quadratic tets and on a state in motion, linear_solver where it is not
  // stable.
  ErrorEstimate estimate_error(const Points& rest_points) const;

  // A copy of state (with velocities) and settings; restore() brings back the same bits.
  class Snapshot;
  std::shared_ptr<const Snapshot> snapshot() const;
  void restore(const std::shared_ptr<const Snapshot>& snapshot);

  // Snapshots as bytes, to be kept in files: bytes_of() below, and back, in a stepper of the same
  // scene. Versioned and checksummed; read_snapshot() throws Error(file) for what is damaged or of
  // another version, Error(invalid_argument) for another mesh, other constraints or compartments.
  std::shared_ptr<const Snapshot> read_snapshot(const Bytes& bytes) const;
  // The scene, the options (save `progress`), state and settings: all that a bug report needs. The
  // stepper made from it goes on with the same bits in the same build. replay() throws Error(file).
  Bytes record() const;
  static Stepper replay(const Bytes& bytes, std::function<bool(const Progress&)> progress = {});

 private:
  class Impl;
  std::unique_ptr<Impl> m_impl;
};

Bytes bytes_of(const Stepper::Snapshot& snapshot);

}  // namespace brainshift
