// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

/// Colours of a report's page, 0xRRGGBB: dark enough to be read on a poor printer.
namespace versine::report::colours {

inline constexpr std::uint32_t ink = 0x1b1f24;      ///< text and curves
inline constexpr std::uint32_t muted = 0x57606a;    ///< what explains
inline constexpr std::uint32_t accent = 0x0b5fa5;   ///< headings, the axis, the path taken
inline constexpr std::uint32_t rule = 0xd0d7de;     ///< lines between parts
inline constexpr std::uint32_t good = 0x1a7f37, good_fill = 0xeaf7ee;
inline constexpr std::uint32_t doubt = 0x9a6700, doubt_fill = 0xfdf6e3;
inline constexpr std::uint32_t bad = 0xb3261e, bad_fill = 0xfcecea;

}  // namespace versine::report::colours
