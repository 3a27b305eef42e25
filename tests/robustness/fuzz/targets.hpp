// What is done with an arbitrary piece of bytes. A target returns, or the process ends: anything thrown
// but brainshift::Error, any promise of the headers that is broken, whatever a sanitizer finds.
#pragma once

#include <cstddef>
#include <cstdint>

namespace brainshift::test {

void fuzz_vtu(const std::uint8_t* data, std::size_t size);  // as the content of a file
void fuzz_vtp(const std::uint8_t* data, std::size_t size);
void fuzz_mcp(const std::uint8_t* data, std::size_t size);  // as a complementarity problem
void fuzz_mesh(const std::uint8_t* data,
               std::size_t size);  // as nodes and tets, and a solve on them
void fuzz_snapshot(const std::uint8_t* data, std::size_t size);   // as what was done to one, sealed again
void fuzz_recording(const std::uint8_t* data, std::size_t size);
void fuzz_calls(const std::uint8_t* data, std::size_t size);      // as calls of the C face

}  // namespace brainshift::test
