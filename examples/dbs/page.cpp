#include "page.hpp"

#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <spawn.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace dbs {
namespace {

constexpr const char* python = "/usr/bin/python3";

// Exit status; -1: it was ended by a signal.
int run_script(std::vector<std::string> words) {
  words.insert(words.begin(), {python, "-B", DBS_REPORT_SCRIPT});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failed = posix_spawn(&child, python, nullptr, nullptr, arguments.data(), environ);
  if (failed) {
    throw Error(ErrorCode::file, std::string("--report: ") + python + " cannot be started: " + std::strerror(failed));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

void check_page(const Options& o) {
  if (o.report.empty()) return;
  if (!o.files || !o.vtk || o.plan) {
    throw Error(ErrorCode::invalid_argument,
                "--report needs the files of a procedure: leave --no-files, --no-vtk and --plan out");
  }
  if (run_script({"--check"}) != 0) {
    throw Error(ErrorCode::file, "--report: no page can be drawn here: install what it needs "
                "(cmake/install-deps.sh docs)");
  }
}

void write_page(const Options& o) {
  if (o.report.empty()) return;
  if (run_script({"--head", o.head, o.out, "--out", o.report}) != 0) {
    throw Error(ErrorCode::file, "--report " + o.report + ": was not written, for the reason above; the results "
                "are in " + o.out);
  }
}

}  // namespace dbs
