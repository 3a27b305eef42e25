// The problems of repeated_rows.hpp by the solvers of Siconos. Without it the table is empty, and says why.
#include "axes.hpp"

#ifndef BRAINSHIFT_WITH_SICONOS

namespace brainshift::stability {

void repeated_rows_by_siconos() { std::printf("absent\n%s\n", BRAINSHIFT_NO_SICONOS); }

}  // namespace brainshift::stability

#else

#include "mcp_siconos/siconos.hpp"
#include "repeated_rows.hpp"

namespace brainshift::stability {
namespace {

using namespace test::siconos;

// Residual of the row at its bounds, in units of the largest |q|.
double residual(const Case& c, const VectorXd& z) {
  const VectorXd w = c.M * z + c.q;
  const VectorXd clamped = (z - w).cwiseMax(c.lower).cwiseMin(c.upper);
  return (z - clamped).cwiseAbs().maxCoeff() / c.q.cwiseAbs().maxCoeff();
}

void row(Rows kind, int count, int solver) {
  const Case c = repeated(kind, count);
  const int n = int(c.q.size());
  const Solution s = kind == Rows::boxes  ? solve_boxes(c, solver)
                     : kind == Rows::free ? solve_mlcp(c.M, c.q, n, solver)
                                          : solve_lcp(c.M, c.q, solver);
  std::printf("%s,%s,%d,%d,,,%.1e,%.1e,%.1e,%s\n", name(solver), to_string(kind), count, n,
              residual(c, s.z), off_single(kind, s.z), s.z.cwiseAbs().maxCoeff(),
              s.info == 0 ? "solved" : "not solved");
  std::fflush(stdout);  // some end the process
}

}  // namespace

void repeated_rows_by_siconos() {
  std::printf(repeated_header);
  for (const int solver : {SICONOS_LCP_LEMKE, SICONOS_LCP_PIVOT, SICONOS_LCP_NEWTON_MIN_FBLSA,
                           SICONOS_LCP_NEWTONMIN, SICONOS_LCP_PGS}) {
    for (const int count : copies) row(Rows::one_sided, count, solver);
  }
  for (const int solver : {SICONOS_RELAY_LEMKE, SICONOS_RELAY_AVI_CAOFERRIS, SICONOS_RELAY_PGS}) {
    for (const int count : copies) row(Rows::boxes, count, solver);
  }
  for (const int count : copies) row(Rows::free, count, SICONOS_MLCP_PGS);
}

}  // namespace brainshift::stability

#endif
