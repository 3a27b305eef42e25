// Complementarity problems through the C face: the bits of the C++ library.
#include "brainshift/mcp.hpp"

#include <limits>

#include "cpp_scene.hpp"
#include "world.hpp"

namespace brainshift::test {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

// Free, one-sided and boxed rows; not symmetric, so that rows and columns cannot be confused.
class Mcp : public testing::Test {
 protected:
  World w;
  brs_mcp_options options;
  brs_mcp_report report;
  double M[16] = {4, 1, 0, -1, 0.5, 3, 1, 0, 0, 1.5, 5, 2, -1, 0, 1, 6};
  double q[4] = {-3, 2, -9, 1}, lower[4] = {-inf, 0, 0, -0.1}, upper[4] = {inf, inf, 1, 0.1};
  double z[4] = {7, 7, 7, 7}, slack[4] = {7, 7, 7, 7};
  std::int32_t conflict[4] = {7, 7, 7, 7};

  Mcp() {
    brs_mcp_options_init(&options, sizeof options);
    brs_mcp_report_init(&report, sizeof report);
  }
  brs_status solve(std::int64_t count = 4) {
    return brs_mcp_solve(w.context, M, q, lower, upper, count, &options, z, slack, conflict,
                         &report);
  }
  McpSolution cpp(const McpOptions& chosen = {}) const {
    using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
    const auto vector = [](const double* v) {
      return Eigen::VectorXd(Eigen::Map<const Eigen::Vector4d>(v));
    };
    return solve_mcp(Eigen::Map<const Matrix>(M), vector(q), vector(lower), vector(upper), chosen);
  }
  void expect_untouched() {
    for (int i = 0; i < 4; ++i) EXPECT_TRUE(z[i] == 7 && slack[i] == 7 && conflict[i] == 7) << i;
  }
};

TEST_F(Mcp, SolutionsAndCertificatesAreThoseOfTheCppLibrary) {
  const McpMethod methods[] = {McpMethod::automatic, McpMethod::newton, McpMethod::pivoting,
                               McpMethod::gauss_seidel};
  for (int method = BRS_MCP_AUTOMATIC; method <= BRS_MCP_GAUSS_SEIDEL; ++method) {
    SCOPED_TRACE(method);
    options.method = method;
    w.good(solve());
    McpOptions chosen;
    chosen.method = methods[method];
    const McpSolution expected = cpp(chosen);
    expect_same_bits(expected.z, z);
    expect_same_bits(expected.w, slack);
    EXPECT_EQ(report.status, BRS_OK);
    EXPECT_EQ(report.residual, expected.report.residual);
    EXPECT_EQ(report.iterations, expected.report.iterations);
    EXPECT_EQ(report.rank, expected.report.rank);
    EXPECT_EQ(report.unique, expected.report.unique ? 1 : 0);
    EXPECT_EQ(report.conflict_count, 0);
    for (std::int32_t row : conflict) EXPECT_EQ(row, -1);
  }
  double alone[4];
  w.good(
      brs_mcp_solve(w.context, M, q, lower, upper, 4, nullptr, alone, nullptr, nullptr, nullptr));
  expect_same_bits(cpp().z, alone);
  w.good(brs_mcp_solve(w.context, nullptr, nullptr, nullptr, nullptr, 0, nullptr, nullptr, nullptr,
                       nullptr, nullptr));
}

TEST_F(Mcp, RowsThatContradictEachOtherAreNamed) {
  // Two walls approach past each other; the last two rows are free of them.
  const double walls[16] = {1, -1, 0, 0, -1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::copy(std::begin(walls), std::end(walls), M);
  std::fill(std::begin(q), std::end(q), -1.0);
  std::fill(std::begin(lower), std::end(lower), 0.0);
  std::fill(std::begin(upper), std::end(upper), inf);
  EXPECT_EQ(solve(), BRS_INFEASIBLE);
  EXPECT_EQ(w.message(), "infeasible: rows 0, 1 contradict each other");
  EXPECT_EQ(report.status, BRS_INFEASIBLE);
  EXPECT_EQ(report.conflict_count, 2);
  const std::int32_t expected[] = {0, 1, -1, -1};
  EXPECT_TRUE(std::equal(std::begin(conflict), std::end(conflict), expected));
}

TEST_F(Mcp, WhoseIterationsRunOutSaySo) {
  options.method = BRS_MCP_GAUSS_SEIDEL;
  options.max_sweeps = 1;
  EXPECT_EQ(solve(), BRS_NOT_CONVERGED);
  EXPECT_EQ(w.message().find("not converged"), 0u) << w.message();
  McpOptions chosen;
  chosen.method = McpMethod::gauss_seidel;
  chosen.max_sweeps = 1;
  expect_same_bits(cpp(chosen).z, z);
  EXPECT_GT(report.residual, options.tolerance);
}

TEST_F(Mcp, ProblemsThatMakeNoSenseAreRefusedAndNothingIsWritten) {
  for (std::int64_t count : {std::int64_t(-1), std::int64_t(1) << 31, INT64_MAX, INT64_MIN})
    EXPECT_EQ(solve(count), BRS_ERROR_SIZE) << count;
  EXPECT_EQ(solve(INT32_MAX), BRS_ERROR_MEMORY);  // its square does not fit a size
  for (int missing = 0; missing < 5; ++missing) {
    const auto given = [&](int i, double* array) { return i == missing ? nullptr : array; };
    EXPECT_EQ(brs_mcp_solve(w.context, given(0, M), given(1, q), given(2, lower), given(3, upper),
                            4, nullptr, given(4, z), nullptr, nullptr, nullptr),
              BRS_ERROR_NULL)
        << missing;
  }
  std::swap(lower[2], upper[2]);
  EXPECT_EQ(solve(), BRS_ERROR_INVALID_ARGUMENT);
  EXPECT_NE(w.message().find("2"), std::string::npos) << w.message();
  std::swap(lower[2], upper[2]);
  M[5] = NAN;
  EXPECT_EQ(solve(), BRS_ERROR_NOT_FINITE);
  expect_untouched();
}

TEST_F(Mcp, OptionsThatMakeNoSenseAreRefusedAndNothingIsWritten) {
  const brs_mcp_options good = options;
  for (std::int64_t brs_mcp_options::*number :
       {&brs_mcp_options::method, &brs_mcp_options::max_iterations, &brs_mcp_options::max_pivots,
        &brs_mcp_options::max_sweeps}) {
    for (std::int64_t value : {std::int64_t(-1), INT64_MAX}) {
      options = good;
      options.*number = value;
      EXPECT_EQ(solve(), BRS_ERROR_INVALID_ARGUMENT) << w.message();
      EXPECT_NE(w.message().find(std::to_string(value)), std::string::npos) << w.message();
    }
  }
  options = good;
  for (std::int64_t size : {std::int64_t(0), std::int64_t(-8), std::int64_t(12), INT64_MAX}) {
    options.struct_size = size;
    EXPECT_EQ(solve(), BRS_ERROR_STRUCT_SIZE);
    options.struct_size = sizeof options;
    report.struct_size = size;
    EXPECT_EQ(solve(), BRS_ERROR_STRUCT_SIZE);
    report.struct_size = sizeof report;
  }
  expect_untouched();
  const McpOptions expected;
  EXPECT_EQ(good.tolerance, expected.tolerance);
  EXPECT_EQ(good.noise, expected.noise);
  EXPECT_EQ(good.max_iterations, expected.max_iterations);
  EXPECT_EQ(good.max_pivots, expected.max_pivots);
  EXPECT_EQ(good.max_sweeps, expected.max_sweeps);
}

}  // namespace
}  // namespace brainshift::test
