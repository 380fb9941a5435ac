#include "engine/base/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

namespace abbe {

double memory_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  double bytes = std::numeric_limits<double>::infinity();
  if (pages > 0 && page_bytes > 0) bytes = double(pages) * double(page_bytes);
  rlimit allowed{};
  if (getrlimit(RLIMIT_AS, &allowed) == 0 && allowed.rlim_cur != RLIM_INFINITY)
    bytes = std::min(bytes, double(allowed.rlim_cur));
  return bytes;
}

}  // namespace abbe
