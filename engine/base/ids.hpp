// Typed indices. An Id<Tag> is an int that cannot be mixed up with an index into another table.
#pragma once

#include <compare>
#include <stdexcept>
#include <string>

namespace abbe {

template <class Tag>
struct Id {
  int value = -1;
  constexpr bool valid() const { return value >= 0; }
  constexpr auto operator<=>(const Id&) const = default;
};

/// Thrown for mistakes of the program itself, never for a user's; the command line turns it into exit code 3.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

#define ABBE_STRINGIZE_(x) #x
#define ABBE_STRINGIZE(x) ABBE_STRINGIZE_(x)
#define ABBE_CHECK(condition)                                                                           \
  do {                                                                                                  \
    if (!(condition))                                                                                   \
      throw ::abbe::InternalError(__FILE__ ":" ABBE_STRINGIZE(__LINE__) ": check failed: " #condition); \
  } while (false)

}  // namespace abbe
