// The inputs of the fuzzers as an ordinary test: what they have kept, the fixtures, and some noise.
#include <filesystem>
#include <random>
#include <sstream>

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

// One input per line of a file, in hexadecimal digits.
int replay_lines(const std::string& name, Target target) {
  std::istringstream lines(io::read_text(std::string(BRAINSHIFT_FUZZ_CORPUS) + "/" + name + ".hex"));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) bytes += char(std::stoi(line.substr(i, 2), nullptr, 16));
    run(target, bytes);
  }
  return count;
}

TEST(Fuzz, EveryInputThatReachedSomethingNewIsReplayed) {
  EXPECT_GE(replay_lines("vtu", fuzz_vtu), 30);
  EXPECT_GE(replay_lines("vtp", fuzz_vtp), 30);
  EXPECT_GE(replay_lines("mcp", fuzz_mcp), 300);
  EXPECT_GE(replay_lines("mesh", fuzz_mesh), 300);
  EXPECT_GE(replay_lines("snapshot", fuzz_snapshot), 200);
  EXPECT_GE(replay_lines("recording", fuzz_recording), 20);
#ifdef WITH_CAPI
  EXPECT_GE(replay_lines("calls", fuzz_calls), 50);
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
