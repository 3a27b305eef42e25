// What the certificate of a solve says of the BLAS that is loaded: `report THREADS` fails where that is not
// the number in the report, or where the sentence for the log does not say the same.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "capi/world.hpp"

namespace {

void keep(brs_status, const char* text, void* kept) { *static_cast<std::string*>(kept) = text; }

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "report: needs the number of threads that is expected\n");
    return 2;
  }
  const long expected = std::strtol(argv[1], nullptr, 10);
  brainshift::test::World w;
  std::string line;
  brs_solve_report report;
  w.good(brs_solve_report_init(&report, sizeof report));
  w.good(brs_context_set_log(w.context, &keep, &line));
  w.good(w.solve_after_loss(5000.0, &report));
  std::printf("blas_threads %ld\n%s\n", long(report.blas_threads), line.c_str());
  const std::string sentence = "the same bits are not promised again: the BLAS " +
                               (expected > 1 ? "may use " + std::to_string(expected) + " threads"
                                             : std::string("does not tell how many threads it uses"));
  const bool said = line.find(sentence) != std::string::npos;
  const bool silent = line.find("BLAS") == std::string::npos;
  const bool right = report.blas_threads == expected && (expected == 1 ? silent : said);
  std::printf("%s\n", right ? "as expected" : "NOT what was expected");
  return right ? 0 : 1;
}
