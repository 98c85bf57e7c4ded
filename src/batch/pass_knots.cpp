// SPDX-License-Identifier: Apache-2.0
#include "pass_knots.hpp"

#include <cmath>
#include <cstdint>

namespace versine::batch {

namespace {
template <int Bytes>
void append(std::string& out, std::int64_t value) {
  for (int i = 0; i < Bytes; ++i) out.push_back(static_cast<char>((value >> (8 * i)) & 0xFF));
}

template <int Bytes>
std::int64_t take(std::string_view bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (int i = 0; i < Bytes; ++i) {
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)])) << (8 * i);
  }
  return Bytes == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
}
}  // namespace

std::string pack_knots(const std::vector<Knot>& knots) {
  std::string out;
  out.reserve(20 * knots.size());
  for (const Knot& k : knots) {
    append<8>(out, k.time.ns);
    for (const double x : {k.distance, k.speed, k.sigma}) append<4>(out, std::llround(1000.0 * x));
  }
  return out;
}

std::vector<Knot> unpack_knots(std::string_view bytes) {
  std::vector<Knot> out;
  for (std::size_t at = 0; at + 20 <= bytes.size(); at += 20) {
    const auto number = [&](std::size_t offset) { return 1e-3 * static_cast<double>(take<4>(bytes, at + offset)); };
    out.push_back({{take<8>(bytes, at)}, number(8), number(12), number(16)});
  }
  return out;
}

}  // namespace versine::batch
