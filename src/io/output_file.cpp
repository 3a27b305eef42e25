#include "output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "file_error.hpp"

namespace brainshift::io {

namespace {

// A file beside the one to be written; gone again unless it has taken its place.
class Temporary {
 public:
  // "x": never opens a file that is there, be it another writer's temporary or a link set as a trap.
  explicit Temporary(const std::string& path) {
    constexpr int attempts = 100;
    for (int i = 0; i < attempts && !m_file; ++i) {
      m_path = path + "." + std::to_string(i) + ".tmp";
      m_file = std::fopen(m_path.c_str(), "wbx");
      if (!m_file && errno != EEXIST) break;
    }
    if (!m_file) fail(path, std::string("cannot be written: ") + std::strerror(errno));
  }
  ~Temporary() {
    // Open or not placed only after an error, which is the one that is told.
    if (m_file) (void)std::fclose(m_file);
    if (!m_placed) (void)std::remove(m_path.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  // Of what went wrong, 0: nothing.
  int write(const std::string& content) {
    const bool written = std::fwrite(content.data(), 1, content.size(), m_file) == content.size();
    const int error = errno;
    const bool closed = std::fclose(m_file) == 0;
    m_file = nullptr;
    return written && closed ? 0 : written ? errno : error;
  }
  int place(const std::string& path) {
    m_placed = std::rename(m_path.c_str(), path.c_str()) == 0;
    return m_placed ? 0 : errno;
  }

 private:
  std::string m_path;
  std::FILE* m_file = nullptr;
  bool m_placed = false;
};

}  // namespace

void write_whole_file(const std::string& path, const std::string& content) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    fail(path, "cannot be written: not a regular file");
  }
  Temporary temporary(path);
  int wrong = temporary.write(content);
  if (wrong == 0) wrong = temporary.place(path);
  if (wrong != 0) fail(path, std::string("cannot be written: ") + std::strerror(wrong));
}

}  // namespace brainshift::io
