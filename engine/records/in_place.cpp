#include "in_place.hpp"

#include <algorithm>
#include <vector>

#include "lanes.hpp"
#include "memory_curve.hpp"

namespace hyst {
namespace {

constexpr std::size_t kShort = 4096;   // samples of records that go side by side in lanes
constexpr std::size_t kBlock = 65536;  // samples copied at once, for each thread
constexpr std::size_t kTogether = 16;  // rows: a multiple of every number of lanes

// Whether part of the answer may come from a memory curve, whose last bits depend on where a record
// is cut.
bool may_take_curve(const Chain &chain, Engine wanted) {
    if (wanted == Engine::loop || wanted == Engine::lanes) return false;
    return std::any_of(chain.stages().begin(), chain.stages().end(), [](const Stage &stage) {
        return Lanes::can_take(stage) && stage.kind->plays->bank(stage.model) != nullptr;
    });
}

// Evaluates a copy of so many rows, and puts it back where a sample is refused.
class Copied {
public:
    Copied(const Chain &chain, const Options &options) : chain_(chain), options_(options) {}
    std::size_t run(double *states, double *y, std::size_t rows, std::size_t samples) {
        copy_.assign(y, y + rows * samples);
        const std::size_t taken =
            evaluate(chain_, states, copy_.data(), y, rows, samples, options_, nullptr);
        if (taken < copy_.size()) std::copy(copy_.begin(), copy_.end(), y);
        return taken;
    }

private:
    const Chain &chain_;
    const Options options_;
    std::vector<double> copy_;
};

// Lanes and loop give the same bits wherever a record is cut.
std::size_t run_in_blocks(const Chain &chain, double *state, double *y, std::size_t samples,
                          const Options &options) {
    const Engine engine = options.engine == Engine::loop ? Engine::loop : Engine::lanes;
    const std::size_t block = kBlock * options.threads;
    const std::vector<double> before(state, state + chain.state_length());
    Copied copied(chain, {engine, options.threads});
    for (std::size_t k = 0; k < samples; k += block) {
        const std::size_t count = std::min(block, samples - k);
        const std::size_t taken = copied.run(state, y + k, 1, count);
        if (taken == count) continue;
        std::copy(before.begin(), before.end(), state);
        return k + taken;
    }
    return samples;
}

std::size_t run_long(const Chain &chain, double *state, double *y, std::size_t samples,
                     const Options &options) {
    if (!may_take_curve(chain, options.engine)) {
        return run_in_blocks(chain, state, y, samples, options);
    }
    if (chain.stages().size() > 1) return Copied(chain, options).run(state, y, 1, samples);
    const Stage &stage = chain.stages()[0];
    if (choose(stage, state, y, samples, options.engine).engine != Engine::memory_curve) {
        return run_in_blocks(chain, state, y, samples, options);
    }
    if (run_curve_in_place(stage, state, y, samples, options.threads)) return samples;
    return Copied(chain, options).run(state, y, 1, samples);
}

}  // namespace

std::size_t evaluate_in_place(const Chain &chain, double *states, double *y, std::size_t rows,
                              std::size_t samples, const Options &options) {
    const std::size_t length = chain.state_length(), total = rows * samples;
    const std::vector<double> before(states, states + rows * length);
    const std::size_t fitting = samples == 0 ? 0 : kBlock / samples / kTogether * kTogether;
    const std::size_t together = samples > kShort ? 1 : std::max(kTogether, fitting);
    Copied copied(chain, options);
    for (std::size_t row = 0; row < rows && samples > 0; row += together) {
        const std::size_t count = std::min(together, rows - row);
        double *state = states + row * length, *at = y + row * samples;
        const std::size_t taken = samples > kShort ? run_long(chain, state, at, samples, options)
                                                   : copied.run(state, at, count, samples);
        if (taken == count * samples) continue;
        std::copy(before.begin(), before.end(), states);
        return row * samples + taken;
    }
    return total;
}

}  // namespace hyst
