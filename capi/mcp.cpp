// Mixed complementarity problems, alone.
#include "brainshift/mcp.hpp"

#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd square(const double* values, std::int64_t count) {
  const Index size = checked_count(count, "rows");
  require_array(values, count, "rows of the matrix");
  RowMajor matrix(size, size);
  if (size > 0) std::memcpy(matrix.data(), values, std::size_t(matrix.size()) * sizeof *values);
  return matrix;
}

Eigen::VectorXd vector(const double* values, std::int64_t count, const char* what) {
  return rows<Eigen::VectorXd>(values, count, what);
}

McpMethod method_of(std::int64_t method) {
  switch (method) {
    case BRS_MCP_AUTOMATIC: return McpMethod::automatic;
    case BRS_MCP_NEWTON: return McpMethod::newton;
    case BRS_MCP_PIVOTING: return McpMethod::pivoting;
    case BRS_MCP_GAUSS_SEIDEL: return McpMethod::gauss_seidel;
    default:
      throw Refusal(BRS_ERROR_INVALID_ARGUMENT,
                    "there is no method with the number " + std::to_string(method));
  }
}

brs_mcp_options mcp_defaults() {
  const McpOptions d;
  return {sizeof(brs_mcp_options), BRS_MCP_AUTOMATIC, d.noise,     d.tolerance,
          d.max_iterations,        d.max_pivots,      d.max_sweeps};
}

McpOptions mcp_options_of(const brs_mcp_options* given) {
  brs_mcp_options o = mcp_defaults();
  if (given) o = read(given, o, "options");
  return {method_of(o.method),
          o.noise,
          o.tolerance,
          checked_int(o.max_iterations, "options->max_iterations"),
          checked_int(o.max_pivots, "options->max_pivots"),
          checked_int(o.max_sweeps, "options->max_sweeps")};
}

brs_status status_of(McpStatus status) {
  switch (status) {
    case McpStatus::solved: return BRS_OK;
    case McpStatus::infeasible: return BRS_INFEASIBLE;
    case McpStatus::not_converged: return BRS_NOT_CONVERGED;
  }
  return BRS_ERROR_INTERNAL;
}

brs_mcp_report mcp_report_of(const McpReport& r) {
  return {sizeof(brs_mcp_report), status_of(r.status),       r.residual, r.iterations, r.rank,
          r.unique ? 1 : 0,       int64_t(r.conflict.size())};
}

void write_conflict(Indices rows, std::int64_t count, std::int32_t* into) {
  rows.resize(std::size_t(count), -1);
  if (count > 0) std::memcpy(into, rows.data(), rows.size() * sizeof *into);
}

}  // namespace

brs_status brs_mcp_options_init(brs_mcp_options* options, int64_t struct_size) {
  return init(options, struct_size, mcp_defaults());
}

brs_status brs_mcp_report_init(brs_mcp_report* report, int64_t struct_size) {
  return init(report, struct_size, mcp_report_of(McpReport()));
}

brs_status brs_mcp_solve(brs_context* context, const double* matrix, const double* q,
                         const double* lower, const double* upper, int64_t count,
                         const brs_mcp_options* options, double* z, double* w, int32_t* conflict,
                         brs_mcp_report* report) {
  return guard(context, [&](brs_context& c) -> brs_status {
    if (report) checked_size(report, "report");
    const McpOptions chosen = mcp_options_of(options);
    const Eigen::MatrixXd m = square(matrix, count);
    require_array(z, count, "values of z");
    McpSolution found =
        solve_mcp(m, vector(q, count, "values of q"), vector(lower, count, "lower bounds"),
                  vector(upper, count, "upper bounds"), chosen);
    write_array(found.z, z);
    if (w) write_array(found.w, w);
    if (conflict) write_conflict(found.report.conflict, count, conflict);
    if (report) write(report, mcp_report_of(found.report), "report");
    const brs_status status = status_of(found.report.status);
    if (status != BRS_OK) c.context->say(found.report.message.c_str());
    return status;
  });
}
