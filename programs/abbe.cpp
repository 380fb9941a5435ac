// The command `abbe`. Exit codes: commands/commands.hpp.
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

#include "programs/commands/commands.hpp"
#include "programs/options.hpp"
#include "programs/terminal.hpp"

namespace {

/// Matrices of some megabytes come and go all the time. Given back to the system each time, their pages would be asked for and
/// cleared anew, which takes longer than some of the work on them. And the first time, a page of two megabytes is asked for
/// in less time than 512 small ones: the system gives those where it is told that they are welcome.
void take_memory_at_once() {
#ifdef __GLIBC__
  constexpr int kMegabyte = 1 << 20, kRoom = 256 * kMegabyte;  // of addresses: memory is taken when it is written to
  mallopt(M_MMAP_THRESHOLD, 32 * kMegabyte);                   // the most that it takes
  mallopt(M_TRIM_THRESHOLD, 2 * kRoom);
  mallopt(M_TOP_PAD, kRoom);
  if (void* const first = std::malloc(kMegabyte)) {  // not where so much is not allowed
    constexpr std::uintptr_t kPage = 4096;
    const auto begin = (reinterpret_cast<std::uintptr_t>(first) + kPage) / kPage * kPage,
               end = reinterpret_cast<std::uintptr_t>(sbrk(0));
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // refused, it is only slower
    std::free(first);
  }
  mallopt(M_TOP_PAD, 16 * kMegabyte);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  take_memory_at_once();
#ifdef SIGXFSZ
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of the file size is then an error of the write, and nothing is left half
#endif
  try {
    return abbe::parse_command_line(argc, argv)();
  } catch (const abbe::UserError& error) {
    abbe::print_messages(error.diagnostics());
    return abbe::kUnusable;
  } catch (const std::bad_alloc&) {
    abbe::print_messages({abbe::diagnostic(abbe::Code::E0620, "the memory is not enough for this command",
                                           "ask for fewer virtual machines (--machines), or give it less to read")});
    return abbe::kUnusable;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "abbe: internal fault: %s\nPlease report this with the command and its input files.\n",
                 error.what());
    return abbe::kFault;
  }
}
