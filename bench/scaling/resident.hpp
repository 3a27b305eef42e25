// Resident memory of this process, as the kernel counts it.
#pragma once

#include <malloc.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace bench {

// Of /proc/self/status, in bytes; 0 where there is no such line.
inline std::int64_t of_status(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::int64_t kib = 0;
    if (word == name + ":" && status >> kib) return 1024 * kib;
  }
  return 0;
}

// How far resident memory rises from now on.
class ResidentPeak {
 public:
  // Gives back what malloc keeps, or the rise would be taken from that unseen; forgets the peak so far.
  ResidentPeak() {
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";
    m_before = of_status("VmRSS");
  }
  std::int64_t rise() const { return of_status("VmHWM") - m_before; }

 private:
  std::int64_t m_before;
};

}  // namespace bench
