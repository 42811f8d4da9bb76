// Chooses the kernels once, when the module is loaded.
#include "kernels.hpp"

#include <atomic>
#include <cstring>

namespace hyst {

// One table per compiled instruction set; see CMakeLists.txt.
#define HYST_TABLE(name)               \
    namespace name {                   \
    extern const Kernels kKernelTable; \
    }
HYST_TABLE(baseline)
#if defined(HYST_X86)
HYST_TABLE(avx2)
HYST_TABLE(avx512)
#endif

namespace {

constexpr std::size_t kMost = 3;

struct Available {
    const Kernels *table[kMost + 1] = {};
    std::atomic<const Kernels *> in_use{nullptr};

    Available() {
        std::size_t count = 0;
#if defined(HYST_X86)
        __builtin_cpu_init();
        const bool fma = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
        if (fma && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
            __builtin_cpu_supports("avx512vl")) {
            table[count++] = &avx512::kKernelTable;
        }
        if (fma) table[count++] = &avx2::kKernelTable;
#endif
        table[count++] = &baseline::kKernelTable;
        in_use = table[0];
    }
};

Available &available() {
    static Available chosen;
    return chosen;
}

}  // namespace

const Kernels &kernels() { return *available().in_use.load(std::memory_order_relaxed); }

const Kernels *const *available_kernels() { return available().table; }

bool use_kernels(const char *name) {
    for (const Kernels *const *each = available_kernels(); *each != nullptr; ++each) {
        if (std::strcmp((*each)->name, name) == 0) {
            available().in_use = *each;
            return true;
        }
    }
    return false;
}

}  // namespace hyst
