// The entry of libFuzzer, compiled once per target.
#include "robustness/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  brainshift::test::BRAINSHIFT_FUZZ_TARGET(data, size);
  return 0;
}
