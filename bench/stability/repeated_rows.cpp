#include "repeated_rows.hpp"

#include "axes.hpp"

namespace brainshift::stability {
namespace {

const char* name(McpMethod method) {
  switch (method) {
    case McpMethod::automatic: return "automatic";
    case McpMethod::newton: return "Newton";
    case McpMethod::pivoting: return "pivoting";
    case McpMethod::gauss_seidel: return "Gauss-Seidel";
  }
  return "";
}

const char* name(McpStatus status) {
  return status == McpStatus::solved       ? "solved"
         : status == McpStatus::infeasible ? "infeasible"
                                           : "not_converged";
}

}  // namespace

void repeated_rows() {
  std::printf(repeated_header);
  for (const McpMethod method :
       {McpMethod::automatic, McpMethod::newton, McpMethod::pivoting, McpMethod::gauss_seidel}) {
    for (const Rows kind : kinds) {
      for (const int count : copies) {
        const Case c = repeated(kind, count);
        McpOptions options;
        options.method = method;
        const McpSolution s = solve_mcp(c.M, c.q, c.lower, c.upper, options);
        std::printf("%s,%s,%d,%d,%d,%d,%.1e,%.1e,%.1e,%s\n", name(method), to_string(kind), count,
                    int(c.q.size()), s.report.rank, s.report.iterations, s.report.residual,
                    off_single(kind, s.z), s.z.cwiseAbs().maxCoeff(), name(s.report.status));
      }
    }
  }
}

}  // namespace brainshift::stability
