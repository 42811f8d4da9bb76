// Feeds a fuzz target pseudo-random bytes where there is no libFuzzer.
//   engines [SECONDS [SEED]]    seconds 0: the one input of this seed, again
// Input i has the seed SEED + i, which is told when it fails.
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);
extern "C" const char *__asan_default_options() { return "abort_on_error=1"; }
extern "C" const char *__ubsan_default_options() { return "abort_on_error=1"; }

namespace {

unsigned long seed;

void tell(int) {
    std::fprintf(stderr, "failed: again with   engines 0 %lu\n", seed);
    std::_Exit(1);
}

}  // namespace

int main(int count, char **arguments) {
    const std::time_t seconds = count > 1 ? std::atol(arguments[1]) : 60, start = std::time(nullptr);
    const unsigned long first = count > 2 ? std::strtoul(arguments[2], nullptr, 10) : 1;
    std::signal(SIGABRT, tell);
    seed = first;
    do {
        std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
        const auto most = 64u << random() % 8;  // short ones are quick
        std::vector<std::uint8_t> bytes(random() % most);
        for (std::uint8_t &byte : bytes) byte = static_cast<std::uint8_t>(random());
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
        ++seed;
    } while (std::time(nullptr) - start < seconds);
    std::printf("%lu inputs from seed %lu on, nothing found\n", seed - first, first);
}
