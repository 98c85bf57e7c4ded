// SPDX-License-Identifier: Apache-2.0
// Entry point for libFuzzer, one program a reader: VERSINE_FUZZ_READER is its place in the list.
#include "readers_fuzz.hpp"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  versine::fuzz::readers[VERSINE_FUZZ_READER].second(std::string(reinterpret_cast<const char*>(data), size));
  return 0;
}
