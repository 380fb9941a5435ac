// The fuzz tests as one quick, repeatable test: fixed seeds, no fuzzing engine.
// usage: fuzz_smoke ROOT [SEED [COUNT]]   or, to try out the sanitizers: fuzz_smoke --fault NAME
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/exercise.hpp"
#include "tests/fuzz/faults.hpp"
#include "tests/fuzz/programs.hpp"
#include "tests/fuzz/recordings.hpp"

int main(int argc, char** argv) {
  using namespace abbe::fuzz;
  if (argc == 3 && std::string_view(argv[1]) == "--fault") return commit_fault(argv[2]);
  const std::vector<std::string> existing = existing_programs(argv[1]);
  const unsigned seed = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 20261121;
  const int count = argc > 3 ? std::atoi(argv[3]) : 250;
  std::mt19937 random(seed);
  int compiled = 0, ran = 0, total = 0, read = 0;
  std::mt19937 of_recordings(seed);  // of their own: a seed names the same programs with them and without
  const auto take = [&](const std::string& text) {
    const Outcome outcome = exercise(text);
    compiled += outcome.compiled ? 1 : 0;
    ran += outcome.ran ? 1 : 0;
    ++total;
  };
  for (int i = 0; i < count; ++i) {
    take(random_program(random));
    const std::string& victim = existing[random() % existing.size()];
    if (i % 5 == 0 && victim.size() < 20'000) take(victim);
    if (victim.size() < 20'000) take(damaged(victim, existing[random() % existing.size()], random));
    take(damaged(random_program(random), random_program(random), random));
  }
  for (int i = 0; i < 10 * count; ++i) read += exercise_recordings(of_recordings);
  std::printf("%d texts: %d without errors, %d run; %d damaged recordings: %d read\n", total, compiled, ran, 30 * count,
              read);
  const bool enough = total > count && compiled > total / 50 && ran > total / 20 && read > count / 2;
  return enough ? 0 : 1;  // else it tests too little
}
