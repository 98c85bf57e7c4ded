// SPDX-License-Identifier: Apache-2.0
// The entry points of readers_fuzz.cpp without libFuzzer, for any compiler: each file of the corpus, and seeded changes
// of it. Usage: versine_fuzz_replay FOLDER [changes of each file]; the folder's name in it is the reader.
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string_view>

#include "readers_fuzz.hpp"

namespace {
namespace fs = std::filesystem;

std::string changed(std::string text, std::mt19937& random) {
  static constexpr std::array<std::string_view, 10> tokens{"nan", "-inf", "1e999", "-", "",
                                                           ",",   "\n",   "\"",    "$", "99999999999999999999"};
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n)(random); };
  for (std::size_t times = 1 + below(4); times > 0; --times) {
    const std::size_t at = below(text.size());
    switch (below(4)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(below(255));
        break;
      case 1:
        text.erase(at, below(20));
        break;
      case 2:
        text.insert(at, tokens[below(tokens.size() - 1)]);
        break;
      case 3: {  // a line again, somewhere else
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
        const std::string line = text.substr(at, end + 1 - at);
        text.insert(below(text.size()), line);
        break;
      }
      default:
        text.resize(at);
        break;
    }
    if (text.empty()) break;
  }
  return text;
}
}  // namespace

int main(int count, char** arguments) {
  if (count < 2) return 2;
  int changes = 1000;
  if (count > 2) {
    const std::string_view given = arguments[2];
    std::from_chars(given.data(), given.data() + given.size(), changes);
  }
  std::mt19937 random(1);
  std::size_t inputs = 0;
  for (const auto& [name, read] : versine::fuzz::readers) {
    for (const auto& entry : fs::directory_iterator(fs::path(arguments[1]) / name)) {
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
      read(text);
      for (int i = 0; i < changes; ++i) read(changed(text, random));
      inputs += static_cast<std::size_t>(changes) + 1;
    }
  }
  std::printf("%zu inputs\n", inputs);
  return inputs > 0 ? 0 : 1;
}
