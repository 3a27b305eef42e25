#include <cstdlib>

#include "brainshift/error.hpp"
#include "brainshift/mcp.hpp"
#include "robustness/fuzz/numbers.hpp"
#include "robustness/fuzz/targets.hpp"

namespace brainshift::test {

void fuzz_mcp(const std::uint8_t* data, std::size_t size) {
  Numbers numbers(data, size);
  const int n = 1 + numbers.byte() % 5;
  McpOptions options;
  options.method = McpMethod(numbers.byte() % 4);
  options.max_sweeps = 200;
  Eigen::MatrixXd M(n, n);
  Eigen::VectorXd q(n), lower(n), upper(n);
  for (Eigen::Index i = 0; i < M.size(); ++i) M.data()[i] = numbers.number();
  for (Eigen::Index i = 0; i < n; ++i) q[i] = numbers.number();
  for (Eigen::Index i = 0; i < n; ++i) {
    lower[i] = numbers.number();
    upper[i] = numbers.number();
  }
  try {
    const McpSolution s = solve_mcp(M, q, lower, upper, options);
    for (const Index row : s.report.conflict) {
      if (row < 0 || row >= n) std::abort();
    }
    if (s.report.status == McpStatus::infeasible && s.report.conflict.empty()) std::abort();
    if (s.report.status != McpStatus::solved) return;
    if (!s.z.allFinite() || !s.w.allFinite() || !(s.report.residual <= 1e-6)) std::abort();
    if ((s.z.array() < lower.array()).any() || (s.z.array() > upper.array()).any()) std::abort();
  } catch (const Error&) {
  }
}

}  // namespace brainshift::test
