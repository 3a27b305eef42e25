// What Stepper::memory_estimate() says beside what malloc gave. Bounds: never more than a tenth above the
// estimate, so that a host may rely on it, and never less than 0.7 of it, so that it is worth something:
// the border it counts is the largest there may be. Eigen keeps columns of the border in full: it is a
// larger part there, and what is kept across iterations shows.
#include <cstdio>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "procedure.hpp"
#include "support/heap.hpp"
#include "support/walled_block.hpp"

namespace brainshift::test {
namespace {

constexpr double most = WITH_CHOLMOD ? 1.1 : 1.15, least = WITH_CHOLMOD ? 0.7 : 0.6;   // of the estimate

#define SKIP_UNLESS_COUNTED() \
  if (!heap_is_counted()) GTEST_SKIP() << "a sanitizer has its own malloc, which counts nothing"

// peak: bytes beyond what there was before the first solve.
void compare(const std::string& what, const MemoryEstimate& e, std::int64_t peak) {
  constexpr double mib = 1024.0 * 1024.0;
  std::printf("%-28s factor %7.1f  border %6.1f  compliance %5.1f  rest %6.1f  total %7.1f  measured %7.1f MiB, %.2f\n",
              what.c_str(), double(e.factor) / mib, double(e.border) / mib, double(e.compliance) / mib,
              double(e.rest) / mib, double(e.total) / mib, double(peak) / mib,
              double(peak) / double(e.total));
  EXPECT_EQ(e.total, e.factor + e.border + e.compliance + e.rest) << what;
  EXPECT_LE(double(peak), most * double(e.total)) << what;
  EXPECT_GE(double(peak), least * double(e.total)) << what;
}

void compare_block(const std::string& what, const Scene& scene, int leads) {
  Stepper stepper(scene);
  insert_leads(stepper, leads, 45.0);
  const std::int64_t before = heap_in_use();
  const MemoryEstimate estimate = stepper.memory_estimate();
  forget_peak();
  const SolveReport report = stepper.solve_static();
  ASSERT_TRUE(report.converged()) << what << ": " << report.message;
  EXPECT_GT(report.active_contacts, 0) << what;
  EXPECT_EQ(report.coupling_rows > 0, leads > 0) << what;
  compare(what, estimate, heap_peak() - before);
}

TEST(MemoryEstimate, OfABlockWithContactsAndLeads) {
  SKIP_UNLESS_COUNTED();
  for (const auto& [cells, leads] : {std::pair{6, 0}, {6, 4}, {12, 0}, {12, 4}, {17, 0}}) {
    compare_block(std::to_string(cells) + " cells, " + std::to_string(leads) + " leads",
                  walled_block(cells, 2000), leads);
  }
}

TEST(MemoryEstimate, OfEveryElement) {
  SKIP_UNLESS_COUNTED();
  Scene scene = walled_block(8, 400);
  scene.volume_strain = VolumeStrain::nodal;
  compare_block("volume at nodes", scene, 1);
  scene.volume_strain = VolumeStrain::element;
  compare_block("quadratic tets", quadratic(scene), 1);
}

// Every stage of the procedure on a head: the peak so far beside the largest estimate so far.
TEST(MemoryEstimate, OfTheProcedure) {
  SKIP_UNLESS_COUNTED();
  const dbs::Head head = dbs::read_head(HEAD_FOLDER);
  dbs::Options options;
  options.quiet = true;
  options.accuracy = 0.1;   // mm
  dbs::Procedure procedure(head, options);
  const std::int64_t before = heap_in_use();
  forget_peak();
  MemoryEstimate largest;
  for (const dbs::Stage& stage : procedure.plan()) {
    const dbs::StageResult result = procedure.run(stage);
    ASSERT_TRUE(result.report.converged()) << stage.label << ": " << result.report.message;
    const MemoryEstimate estimate = procedure.stepper().memory_estimate();   // with the devices of the stage
    if (estimate.total > largest.total) largest = estimate;
    if (stage.action == dbs::Action::insert_lead || stage.action == dbs::Action::restore) {
      compare("stage " + stage.label, largest, heap_peak() - before);
    }
  }
}

}  // namespace
}  // namespace brainshift::test
