// Allocation 0, 1, 2, ... of every call fails, alone and with all that follow: an error that says so,
// the state as it was, nothing leaked, and the next good step that of an object that never failed.
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <new>

#include "brainshift/io.hpp"
#include "brainshift/mcp.hpp"
#include "linear/sparse_columns.hpp"
#include "robustness/atomicity/failing_malloc.hpp"
#include "robustness/atomicity/world.hpp"

namespace brainshift::test {
namespace {

using Call = std::function<void(World&)>;

bool every_allocation() { return std::getenv("BRAINSHIFT_EVERY_ALLOCATION") != nullptr; }

// All of the first ones, then ever fewer; or every one.
long next_after(long k) { return k + 1 + (every_allocation() ? 0 : k / 8); }

// Runs the call with allocation k failing; true: it went through. What it may throw: bad_alloc, or an
// Error that speaks of memory (CHOLMOD's, METIS', a parser's own status).
bool runs_through(const std::function<void()>& call, long k, Failing how, bool& failed) {
  bool through = false, fits = false;
  std::string message;
  message.reserve(1000);
  let_allocation_fail(k, how);
  try {
    call();
    through = fits = true;
    failed = stop_failing();
  } catch (const std::bad_alloc&) {
    failed = stop_failing();
    fits = true;
  } catch (const Error& error) {
    failed = stop_failing();
    message = error.what();
    fits = message.find("memory") != std::string::npos || error.code() == ErrorCode::file;
  }
  EXPECT_TRUE(fits) << "allocation " << k << ": " << message;
  EXPECT_TRUE(through || failed);
  return through;
}

struct Tally {
  long allocations = 0, tried = 0, refused = 0;
};

// The call on a world of its own, for each k.
Tally fail_each_allocation(const char* name, const Call& call) {
  World untouched;
  const Points next_if_refused = untouched.next();
  World done;
  call(done);
  const WorldState after(done.stepper);
  Tally tally;
  for (const Failing how : {Failing::once, Failing::onwards}) {
    bool failed = true;
    for (long k = 0; failed && k < 10000000; k = next_after(k)) {
      const long outstanding = outstanding_allocations();
      {
        World w;
        const WorldState before(w.stepper);
        const bool through = runs_through([&] { call(w); }, k, how, failed);
        const WorldState now(w.stepper);
        ++tally.tried;
        if (through) {
          EXPECT_TRUE(now == after) << name << ", allocation " << k;
        } else {
          ++tally.refused;
          EXPECT_TRUE(now == before) << name << ", allocation " << k;
          EXPECT_TRUE(same_bits(w.next(), next_if_refused)) << name << ", allocation " << k;
        }
      }
      EXPECT_TRUE(outstanding_allocations() == outstanding || failed_in_metis())
          << name << ", allocation " << k << " leaks";
      tally.allocations = std::max(tally.allocations, k);
      if (testing::Test::HasFailure()) return tally;
    }
  }
  std::printf("%s: %ld allocations, %ld made to fail, %ld refused\n", name, tally.allocations,
              tally.tried, tally.refused);
  return tally;
}

class OutOfMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_fail()) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  }
};

TEST_F(OutOfMemory, StaticSolve) {
  const Tally t = fail_each_allocation("solve_static", [](World& w) { w.stepper.solve_static(); });
  EXPECT_GT(t.refused, 100);
}

TEST_F(OutOfMemory, StepInTime) {
  const Tally t = fail_each_allocation("step", [](World& w) { w.stepper.step(0.01); });
  EXPECT_GT(t.refused, 100);
}

TEST_F(OutOfMemory, Devices) {
  fail_each_allocation("insert", [](World& w) {
    w.stepper.insert(device_of("lead"), {Vec3(8.1, 9.3, 11.2), Vec3::UnitZ()}, held_at_wire());
  });
  fail_each_allocation(
      "exchange", [](World& w) { w.stepper.exchange(w.id, device_of("lead"), held_whole(), 1.0); });
  fail_each_allocation("set_hold", [](World& w) { w.stepper.set_hold(w.id, held_at_wire()); });
  fail_each_allocation("set_friction", [](World& w) { w.stepper.set_friction(w.id, 1e-4, 0.1); });
  fail_each_allocation("remove", [](World& w) { w.stepper.remove(w.id); });
  fail_each_allocation("device", [](World& w) { w.stepper.device(w.id); });
}

TEST_F(OutOfMemory, SettingsAndSnapshots) {
  fail_each_allocation("restore", [](World& w) { w.stepper.restore(w.snapshot); });
  fail_each_allocation("snapshot", [](World& w) { w.stepper.snapshot(); });
  fail_each_allocation("disable", [](World& w) { w.stepper.disable(1); });
  fail_each_allocation("set_gravity", [](World& w) { w.stepper.set_gravity({0, 1000, -9000}); });
  fail_each_allocation("set_velocity",
                       [](World& w) { w.stepper.set_velocity(Points::Zero(27, 3)); });
  fail_each_allocation("check_settings", [](World& w) { w.stepper.check_settings(); });
  fail_each_allocation("points", [](World& w) {
    w.stepper.displacement_at(Points::Constant(3, 3, 11.0));
    w.stepper.rest_points_of(Points::Constant(3, 3, 11.0));
  });
}

// What makes a value either makes it or leaves nothing behind.
void fail_each_allocation_of(const char* name, const std::function<void()>& make) {
  make();  // what is made once for all times (tables, locks) is there
  long count = 0;
  for (const Failing how : {Failing::once, Failing::onwards}) {
    bool failed = true;
    for (long k = 0; failed; k = next_after(k)) {
      const long outstanding = outstanding_allocations();
      runs_through(make, k, how, failed);
      EXPECT_TRUE(outstanding_allocations() == outstanding || failed_in_metis())
          << name << ", allocation " << k << " leaks";
      count = std::max(count, k);
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(count, 0) << name;
  std::printf("%s: %ld allocations\n", name, count);
}

TEST_F(OutOfMemory, ValuesAreMadeOrNotMade) {
  const TetShape box = make_box({30, 30, 30}, 2, 2, 2);
  const SurfaceShape wall = box_wall({-3, -3, -3}, {33, 33, 34});
  const Scene& scene = small_scene();
  fail_each_allocation_of("Mesh", [&] { make_mesh(box); });
  fail_each_allocation_of("Mesh::locate", [&] { make_mesh(box).locate(box.points); });
  SurfaceOptions coarse;
  coarse.grid_spacing = 10.0;
  fail_each_allocation_of("Surface", [&] { Surface::cavity(wall.points, wall.triangles, coarse); });
  fail_each_allocation_of("Csf", [&] {
    Csf(fluid_density, FluidModel::separate,
        {make_compartment("all", wall, all_faces(scene.mesh))});
  });
  fail_each_allocation_of("make_device", [] { make_device("3389", 40.0); });
  fail_each_allocation_of("Stepper", [&] { Stepper s(scene); });
  fail_each_allocation_of("solve_mcp", [] {
    const Eigen::MatrixXd M = Eigen::MatrixXd::Identity(6, 6);
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(6);
    solve_mcp(M, -one, 0.0 * one, 2.0 * one);
  });
}

// Copies of Eigen's own matrix would lose an array.
TEST_F(OutOfMemory, SparseColumnsAreMadeOrNotMade) {
  const std::vector<Eigen::Triplet<double>> entries{{0, 0, 1.0}, {1, 0, 2.0}, {2, 1, 3.0}, {3, 2, 4.0}};
  const auto make = [&entries] {
    SparseColumns columns(4, 3);
    columns.setFromTriplets(entries.begin(), entries.end());
    return columns;
  };
  const SparseColumns columns = make(), other(5, 5);
  fail_each_allocation_of("SparseColumns", [&] { make(); });
  fail_each_allocation_of("SparseColumns, copied", [&] { const SparseColumns copy(columns); });
  fail_each_allocation_of("SparseColumns, cut", [&] { const SparseColumns cut(columns.leftCols(2)); });
  fail_each_allocation_of("SparseColumns, multiplied", [&] {
    const SparseColumns product(columns.transpose() * columns);
  });
  for (long k = 0, failed = 1; failed; ++k) {
    SparseColumns changed = other;
    bool one_failed = false;
    const bool through = runs_through([&] { changed = columns; }, k, Failing::once, one_failed);
    EXPECT_EQ(changed.rows(), through ? 4 : 5);
    EXPECT_EQ(changed.nonZeros(), through ? 4 : 0);
    failed = one_failed;
  }
}

TEST_F(OutOfMemory, AConstraintIsAddedOrNot) {
  for (long k = 0;; ++k) {
    ConstraintSet set;
    set.fix("first", {1});
    bool failed = false;
    const bool through = runs_through(
        [&] {
          set.fix("a name that is too long for the string itself", {2, 3, 4});
        },
        k, Failing::once, failed);
    EXPECT_EQ(set.groups().size(), through ? 2u : 1u);
    EXPECT_EQ(set.fix("next", {5}), through ? 2 : 1) << "an id was lost";
    if (!failed) break;
  }
}

TEST_F(OutOfMemory, FilesAreReadOrRefused) {
  io::Grid grid;
  const TetShape box = make_box({30, 30, 30}, 1, 1, 1);
  grid.points = box.points;
  grid.tets = box.tets;
  grid.node_fields = {{"u", Eigen::MatrixXd::Zero(8, 3), false}};
  const std::string path = testing::TempDir() + "brainshift_out_of_memory.vtu";
  fail_each_allocation_of("write_vtu", [&] { io::write_vtu(path, grid); });
  fail_each_allocation_of("read_vtu", [&] { io::read_vtu(path); });
  std::remove(path.c_str());
}

}  // namespace
}  // namespace brainshift::test
