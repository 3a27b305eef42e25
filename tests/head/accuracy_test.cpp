// --accuracy: stage by stage no node is further than that from where an exact solve leaves it.
#include <gtest/gtest.h>

#include "head_scene.hpp"
#include "procedure.hpp"

namespace dbs {
namespace {

struct Outcome {
  std::vector<Points> shifts;
  int iterations = 0, factorisations = 0;
};

Outcome run(double accuracy) {
  Options options = quiet_options();
  options.accuracy = accuracy;
  Procedure procedure(shipped_head(), options);
  Outcome r;
  for (const Stage& stage : procedure.plan()) {
    const SolveReport report = procedure.run(stage).report;
    EXPECT_TRUE(report.converged()) << stage.label << ": " << report.message;
    r.shifts.push_back(procedure.shift());
    r.iterations += report.iterations;
    r.factorisations += report.factorisations;
  }
  return r;
}

TEST(Accuracy, IsKeptByEveryStage) {
  const Outcome exact = run(0.0), loose = run(0.1);
  ASSERT_EQ(exact.shifts.size(), loose.shifts.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < exact.shifts.size(); ++i) {
    worst = std::max(worst, (exact.shifts[i] - loose.shifts[i]).rowwise().norm().maxCoeff());
  }
  std::printf("accuracy 0.1 mm: off by %.1e mm; %d iterations, %d factors; exact: %d, %d\n", worst,
              loose.iterations, loose.factorisations, exact.iterations, exact.factorisations);
  EXPECT_LE(worst, 0.1);
  EXPECT_LT(loose.iterations, exact.iterations);
  EXPECT_LT(exact.factorisations, exact.iterations);   // factors outlive their iterate
}

}  // namespace
}  // namespace dbs
