// The inputs of the fuzzers as an ordinary test: what was found once, the fixtures, and some noise.
#include <filesystem>
#include <random>

#include "io/io_test.hpp"
#include "robustness/fuzz/targets.hpp"

namespace brainshift::test {
namespace {

using Target = void (*)(const std::uint8_t*, std::size_t);

void run(Target target, const std::string& bytes) {
  target(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
}

int replay(const std::string& folder, Target target) {
  int count = 0;
  if (!std::filesystem::exists(folder)) return count;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    run(target, io::read_text(entry.path().string()));
    ++count;
  }
  return count;
}

const std::string corpus = BRAINSHIFT_FUZZ_CORPUS;

TEST(Fuzz, EveryInputFoundSoFarIsReplayed) {
  replay(corpus + "/vtu", fuzz_vtu);
  replay(corpus + "/vtp", fuzz_vtp);
  replay(corpus + "/mcp", fuzz_mcp);
  replay(corpus + "/mesh", fuzz_mesh);
  replay(corpus + "/snapshot", fuzz_snapshot);
  replay(corpus + "/recording", fuzz_recording);
#ifdef WITH_CAPI
  replay(corpus + "/calls", fuzz_calls);
#endif
}

TEST(Fuzz, TheFixturesGoThroughBothReaders) {
  const std::string fixtures = std::string(BRAINSHIFT_IO_TESTS) + "/fixtures";
  EXPECT_GE(replay(fixtures, fuzz_vtu), 15);
  EXPECT_GE(replay(fixtures, fuzz_vtp), 15);
}

// Noise: the same for every run.
void run_on_noise(int count, std::size_t most, const std::vector<Target>& targets) {
  std::mt19937 random(2026);
  for (int i = 0; i < count; ++i) {
    std::string bytes(20 + random() % most, '\0');
    for (char& c : bytes) c = char(random());
    for (Target target : targets) run(target, bytes);
  }
}

TEST(Fuzz, ProblemsMadeOfNoise) { run_on_noise(3000, 60, {fuzz_mcp, fuzz_mesh}); }
TEST(Fuzz, BytesTamperedWith) { run_on_noise(2000, 60, {fuzz_snapshot, fuzz_recording}); }
#ifdef WITH_CAPI
TEST(Fuzz, CallsInAnyOrder) { run_on_noise(1000, 600, {fuzz_calls}); }
#endif

}  // namespace
}  // namespace brainshift::test
