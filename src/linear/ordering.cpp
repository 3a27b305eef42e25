#include "linear/ordering.hpp"

#include <csignal>
#include <cstdlib>
#include <mutex>
#include <string>

#include <metis.h>

#include "brainshift/error.hpp"

namespace brainshift {
namespace {

// METIS reseeds rand() and swaps the handlers of SIGABRT and SIGTERM while it runs. Both belong to
// the host: they are put back, and one process-wide lock keeps two of our threads apart.
class MetisGuard {
 public:
  MetisGuard() : m_lock(mutex()) {
    m_old_random = initstate(1, m_random, sizeof m_random);
    sigaction(SIGABRT, nullptr, &m_abort);
    sigaction(SIGTERM, nullptr, &m_terminate);
  }
  ~MetisGuard() {
    sigaction(SIGABRT, &m_abort, nullptr);
    sigaction(SIGTERM, &m_terminate, nullptr);
    setstate(m_old_random);
  }

 private:
  static std::mutex& mutex() {
    static std::mutex m;
    return m;
  }
  std::lock_guard<std::mutex> m_lock;
  char m_random[128];
  char* m_old_random;
  struct sigaction m_abort, m_terminate;
};

}  // namespace

Indices nested_dissection(const std::vector<Indices>& adjacency) {
  idx_t count = idx_t(adjacency.size());
  Indices position(adjacency.size());
  if (count < 3) {
    for (std::size_t i = 0; i < position.size(); ++i) position[i] = Index(i);
    return position;
  }
  std::vector<idx_t> start{0}, neighbours;
  for (const Indices& near : adjacency) {
    neighbours.insert(neighbours.end(), near.begin(), near.end());
    start.push_back(idx_t(neighbours.size()));
  }
  if (neighbours.empty()) neighbours.push_back(0);  // METIS wants a valid pointer
  std::vector<idx_t> permutation(adjacency.size()), inverse(adjacency.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  int status = METIS_OK;
  {
    MetisGuard guard;
    status = METIS_NodeND(&count, start.data(), neighbours.data(), nullptr, options,
                          permutation.data(), inverse.data());
  }
  if (status != METIS_OK) {
    throw Error(ErrorCode::linear_solver,
                status == METIS_ERROR_MEMORY
                    ? std::string("METIS could not order the matrix: out of memory")
                    : "METIS could not order the matrix (status " + std::to_string(status) + ")");
  }
  for (std::size_t i = 0; i < position.size(); ++i) position[i] = Index(inverse[i]);
  return position;
}

}  // namespace brainshift
