// A file in memory with a path: written thousands of times without a disk.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>

namespace brainshift::io {

class MemoryFile {
 public:
  MemoryFile() : m_descriptor(memfd_create("brainshift", 0)) {}
  ~MemoryFile() { close(m_descriptor); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(m_descriptor); }
  // False where the file could not be written.
  bool write(const char* data, std::size_t size) const {
    return ftruncate(m_descriptor, 0) == 0 && pwrite(m_descriptor, data, size, 0) == ssize_t(size);
  }
  bool write(const std::string& text) const { return write(text.data(), text.size()); }

 private:
  int m_descriptor;
};

}  // namespace brainshift::io
