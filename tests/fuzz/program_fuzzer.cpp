// libFuzzer target: bytes as a program. Inputs grow by the damage of programs.hpp, which knows the
// language, as well as by libFuzzer's own.
#include <cstdint>
#include <random>

#include "tests/fuzz/exercise.hpp"
#include "tests/fuzz/programs.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t limit);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  abbe::fuzz::exercise(std::string(data, data + size));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t limit, unsigned seed) {
  std::mt19937 random(seed);
  if (random() % 3 == 0) return LLVMFuzzerMutate(data, size, limit);
  const std::string other = abbe::fuzz::random_program(random);
  std::string text = size == 0 ? other : abbe::fuzz::damaged(std::string(data, data + size), other, random);
  if (text.size() > limit) text.resize(limit);
  std::copy(text.begin(), text.end(), data);
  return text.size();
}
