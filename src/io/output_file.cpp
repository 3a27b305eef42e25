#include "output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "file_error.hpp"

namespace brainshift::io {

namespace {

struct Temporary {
  std::string path;
  std::FILE* file = nullptr;
};

// "x": never opens a file that is there, be it another writer's temporary or a link set as a trap.
Temporary open_beside(const std::string& path) {
  constexpr int attempts = 100;
  Temporary temporary;
  for (int i = 0; i < attempts && !temporary.file; ++i) {
    temporary.path = path + "." + std::to_string(i) + ".tmp";
    temporary.file = std::fopen(temporary.path.c_str(), "wbx");
    if (!temporary.file && errno != EEXIST) break;
  }
  if (!temporary.file) fail(path, std::string("cannot be written: ") + std::strerror(errno));
  return temporary;
}

}  // namespace

void write_whole_file(const std::string& path, const std::string& content) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    fail(path, "cannot be written: not a regular file");
  }
  const Temporary temporary = open_beside(path);
  const bool written =
      std::fwrite(content.data(), 1, content.size(), temporary.file) == content.size();
  const int write_error = errno;
  const bool closed = std::fclose(temporary.file) == 0;
  std::string reason;
  if (!written || !closed) {
    reason = std::strerror(written ? errno : write_error);
  } else {
    std::filesystem::rename(temporary.path, path, error);
    if (error) reason = error.message();
  }
  if (!reason.empty()) {
    std::remove(temporary.path.c_str());
    fail(path, "cannot be written: " + reason);
  }
}

}  // namespace brainshift::io
