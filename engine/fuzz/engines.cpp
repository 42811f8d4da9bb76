// Fuzz target: every engine on every instruction set against the core's loop. `make fuzz` builds and
// runs it with driver.cpp; libFuzzer can drive it too (build.sh).
//
// The bytes are a bank, its memory and a record. Numbers come from a few bytes in three ways, so
// that ties, plateaus and rounding all happen: small multiples of 1/8, differences of those by
// rounding, and any double at all.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <algorithm>
#include <memory>
#include <vector>

#include "../records/evaluation.hpp"
#include "../records/gradient.hpp"
#include "../simd/kernels.hpp"
#include "hyst/limited_tracking.h"

namespace {

struct Bytes {
    const std::uint8_t *next;
    std::size_t left;

    std::uint8_t byte() {
        if (left == 0) return 0;
        --left;
        return *next++;
    }
    double number() {
        const std::uint8_t way = byte();
        const double eighths = static_cast<std::int8_t>(byte()) / 8.0;
        if (way < 160) return eighths;
        if (way < 224) return eighths * 0.1 + way * 1e-17;
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
        double any;
        std::memcpy(&any, &bits, sizeof any);
        return any;
    }
    double finite() {
        const double any = number();
        return std::isfinite(any) ? any : 1.0;
    }
};

void demand(bool holds, const char *what) {
    if (holds) return;
    std::fprintf(stderr, "differs: %s, %s\n", what, hyst::kernels().name);
    std::abort();
}

bool same(const std::vector<double> &a, const std::vector<double> &b) {
    return a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

std::unique_ptr<hyst::Chain> chain_of(bool rate_dependent, const std::vector<double> &p,
                                      const std::vector<double> &r) {
    hyst::kinds::Given given{"pi", "", {0.3}, {{"knees", {}}}, {{"plays", p.size()}, {"powers", 1}}, 1.0};
    given.constants.insert(given.constants.end(), p.begin(), p.end());
    given.constants.insert(given.constants.end(), r.begin(), r.end());
    if (rate_dependent) {
        given.kind = "rate_dependent_pi";
        given.constants.insert(given.constants.end(), {0.25, 0.125});
    }
    return std::make_unique<hyst::Chain>(std::vector<hyst::kinds::Given>{given});
}

bool all_finite(const std::vector<double> &u) {
    return std::all_of(u.begin(), u.end(), [](double each) { return std::isfinite(each); });
}

// The loss is refused, by a NaN, where the loop refuses a sample; target is anything finite.
void check_loss(const hyst::Chain &chain, const std::vector<double> &z, const std::vector<double> &u,
                const std::vector<double> &target, hyst::Engine engine, bool refused) {
    std::vector<double> state = z, gradient(chain.parameter_count());
    const double loss = hyst::loss_gradient(chain, state.data(), u.data(), target.data(), u.size(),
                                            {engine, 1}, gradient.data());
    if (refused) demand(std::isnan(loss) && same(state, z), "what the loss refuses");
    if (!refused) demand(!std::isnan(loss), "what the loss takes");
}

// A limited drive stays within its limits and all memory finite, whatever comes in and even where the
// bank that stands for the inverse of the inverse is none. The first numbers make limits and gains.
void check_limits(const hyst::Chain &bank, const std::vector<double> &z,
                  const std::vector<double> &u) {
    if (u.size() < 6) return;
    const auto bounded = [&](std::size_t i) { return std::isfinite(u[i]) ? u[i] : 2.0; };
    const double low = std::min(bounded(0), bounded(1)), high = std::max(bounded(0), bounded(1));
    const double a = 0.875, b[] = {1.0, -0.5}, c = 0.25, w = bounded(2);
    const hyst_limited_tracking block = {
        {1, &a, b, &c, {bounded(3), -1.0}, {0, nullptr}},
        &w,
        {bank.view(), bank.view(), {low, high, std::fabs(bounded(4))}}};
    std::vector<double> state = {0.0}, before(z.size());
    state.insert(state.end(), z.begin(), z.end());
    state.insert(state.end(), z.begin(), z.end());
    state.push_back(low);
    hyst_limited_guard guard = {{low, 0}, 0};
    double v = 0.0, excess = 0.0;
    for (std::size_t k = 5; k < u.size(); ++k) {
        const double drive = hyst_limited_tracking_step(&block, state.data(), before.data(), &guard,
                                                        u[k], u[k - 1], &v, &excess);
        demand(drive >= low && drive <= high, "a limited drive");
        demand(state.back() >= low && state.back() <= high, "the last drive");
    }
    demand(all_finite(state), "the memory of a limited drive");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    Bytes bytes{data, size};
    const std::uint8_t kind = bytes.byte();
    const std::size_t n = 1 + bytes.byte() % 12;
    std::vector<double> r, p, z, u;
    for (std::size_t i = 0; i < n; ++i) r.push_back(std::fabs(bytes.finite()));
    if (kind % 8 != 0) std::sort(r.begin(), r.end());
    for (std::size_t i = 0; i < n; ++i) p.push_back(static_cast<std::int8_t>(bytes.byte()) / 16.0);
    const bool starts = kind & 8;
    for (std::size_t i = 0; i < n; ++i) z.push_back(starts ? bytes.finite() : 0.0);
    const bool repeats = kind & 16;
    while (bytes.left > 0 && u.size() < 1500) {
        u.push_back(kind & 32 ? bytes.number() : bytes.finite());
        for (std::size_t times = repeats ? bytes.byte() % 64 : 0; times > 0; --times) {
            u.push_back(u.back() + (times % 5) * 0.125);
        }
    }
    if (u.empty()) return 0;

    const bool rate_dependent = kind & 64;
    const std::unique_ptr<hyst::Chain> bank = chain_of(rate_dependent, p, r);
    const hyst::Chain &chain = *bank;
    if (rate_dependent) z.insert(z.end(), {0.5, kind & 128 ? 1.0 : 0.0});
    check_limits(chain, z, u);
    for (auto each = hyst::available_kernels(); *each != nullptr; ++each) {
        hyst::use_kernels((*each)->name);
        std::vector<double> state = z, y(u.size());
        const std::size_t taken = hyst::evaluate(chain, state.data(), u.data(), y.data(), 1, u.size(),
                                                 {hyst::Engine::loop, 1}, nullptr);
        for (hyst::Engine engine : {hyst::Engine::lanes, hyst::Engine::memory_curve}) {
            std::vector<double> state_found = z, y_found(u.size());
            const std::size_t found =
                hyst::evaluate(chain, state_found.data(), u.data(), y_found.data(), 1, u.size(),
                               {engine, 1}, nullptr);
            demand(found == taken, "the first bad sample");
            demand(same(state_found, state), "the state");
            if (taken == u.size() && engine == hyst::Engine::lanes) demand(same(y_found, y), "y");
        }
        if (!all_finite(u)) continue;
        for (hyst::Engine engine : {hyst::Engine::lanes, hyst::Engine::memory_curve}) {
            check_loss(chain, z, u, taken == u.size() ? y : u, engine, taken < u.size());
        }
    }
    return 0;
}
