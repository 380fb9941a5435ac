// libFuzzer target: bytes as a machine file.
#include <cstdint>
#include <string>

#include "engine/machine/machine.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    abbe::parse_machine("fuzz.json", std::string(data, data + size));
  } catch (const abbe::UserError&) {  // a file that cannot be used is refused with a message
  }
  return 0;
}
