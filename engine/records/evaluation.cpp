#include "evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hyst/guard.h"
#include "lanes.hpp"
#include "memory_curve.hpp"
#include "../parallel.hpp"
#include "../simd/kernels.hpp"

namespace hyst {
namespace {

constexpr std::size_t kSmallestPart = 16384;  // samples that are worth a thread
constexpr std::size_t kBlock = 4096;          // samples copied, or looked at, while they are in the cache
constexpr double kNot = std::numeric_limits<double>::quiet_NaN();
constexpr double kModerate = 1e150;  // for an output that goes on through stages of any constants

// The memory curve gives up the last bits of y, so it must be worth it.
constexpr double kWorthwhileShare = 0.6;
constexpr double kWorthwhileSaving = 1e5;  // nanoseconds

// The bank of plays that the memory curve can take, or null.
const hyst_pi *curved_bank(const Stage &stage, const double *state) {
    if (!Lanes::can_take(stage)) return nullptr;
    const hyst_pi *bank = stage.kind->plays->bank(stage.model);
    return bank != nullptr && is_admissible(*bank, state) ? bank : nullptr;
}

Choice estimate(const Stage &stage, const double *state, const double *u,
                std::size_t samples) {
    const std::size_t plays = stage.kind->plays->count(stage.model);
    const double each = 1.0 / static_cast<double>(samples);
    Choice choice{Engine::loop, "", cost_of_loop(plays, samples) * each,
                  cost_of_lanes(plays, samples) * each, kNot, {}};
    if (const hyst_pi *bank = curved_bank(stage, state)) {
        choice.rough = roughness(*bank, u, samples);
        choice.memory_curve = cost_of_memory_curve(plays, samples, choice.rough) * each;
    }
    return choice;
}

void take_cheapest(Choice &choice, std::size_t samples) {
    choice.engine = choice.lanes < choice.loop ? Engine::lanes : Engine::loop;
    choice.reason = choice.engine == Engine::lanes ? "cheapest that keeps every bit of y"
                                                   : "the record is short";
    const double exact = std::min(choice.lanes, choice.loop);
    const double saving = (exact - choice.memory_curve) * static_cast<double>(samples);
    if (choice.memory_curve < kWorthwhileShare * exact && saving > kWorthwhileSaving) {
        choice.engine = Engine::memory_curve;
        choice.reason = "few turning points for so many plays and samples";
    }
}

// Calls work(first, count) for block after block, as long as it returns true.
template <class Work>
bool in_blocks(std::size_t samples, const Work &work) {
    for (std::size_t k = 0; k < samples; k += kBlock) {
        if (!work(k, std::min(kBlock, samples - k))) return false;
    }
    return true;
}

// Where to cut a record whose memory curve goes on in what is copied next, and no bit tells: at a
// reversal, where a movement ends anyway. Usually a block away from `first`, rarely further.
std::size_t unseen_cut(const double *u, std::size_t first, std::size_t samples) {
    const auto turns_at = [u](std::size_t k) {
        return (u[k - 1] > u[k - 2] && u[k] < u[k - 1]) || (u[k - 1] < u[k - 2] && u[k] > u[k - 1]);
    };
    if (samples - first <= kBlock) return samples;
    std::size_t k = first + kBlock;
    while (k > first + 2 && !turns_at(k)) --k;
    if (k > first + 2) return k;
    for (k = first + kBlock + 1; k < samples && !turns_at(k);) ++k;
    return k;
}

struct Way {
    Engine engine;
    double limit = kHuge;    // of the sums along a memory curve
    bool is_record = false;  // whether what the curve overwrites is the record itself
};

// This and all that follow return whether all of u and y were finite; along the memory curve also
// false where that is left to the core's order of operations.
bool along_curve(const hyst_pi &pi, const double *state, const double *u, double *y,
                 std::size_t samples, Way way) {
    MemoryCurve curve(pi, state);
    bool finite = true;
    if (u != y) {
        finite = curve.run(u, y, samples);
    } else {
        std::vector<double> copy;
        for (std::size_t k = 0, end = 0; k < samples && finite; k = end) {
            end = way.is_record ? unseen_cut(u, k, samples) : std::min(k + kBlock, samples);
            copy.assign(u + k, u + end);
            finite = curve.run(copy.data(), y + k, end - k);
        }
    }
    return finite && curve.largest() <= headroom(pi, state, way.limit);
}

bool in_loop(const Stage &stage, double *state, const double *u, double *y,
             std::size_t samples) {
    const bool finite = all_finite(u, samples);  // before y, which may be u, is written
    if (stage.kind->run != nullptr) {
        stage.kind->run(stage.model, state, u, y, samples);
    } else {
        stage.step_through(state, u, y, samples);
    }
    return finite && all_finite(y, samples);
}

bool run_part(const Stage &stage, Way way, double *state, const double *u, double *y,
              std::size_t samples) {
    if (way.engine == Engine::lanes) return Lanes(stage).run(state, u, y, samples);
    if (way.engine == Engine::loop) {
        return in_blocks(samples, [&](std::size_t first, std::size_t count) {
            return in_loop(stage, state, u + first, y + first, count);
        });
    }
    const hyst_pi &bank = *stage.kind->plays->bank(stage.model);
    std::vector<double> end(state, state + bank.count);
    Lanes(stage).jump(end.data(), u, samples);
    const bool finite = along_curve(bank, state, u, y, samples, way);
    std::copy(end.begin(), end.end(), state);
    return finite;
}

// Parts of the record on threads, each from the exact state that the parts before it leave.
bool run_parts(const Stage &stage, Way way, double *state, const double *u, double *y,
               std::size_t samples, std::size_t threads) {
    const std::size_t parts = std::min(threads, samples / kSmallestPart);
    if (parts <= 1 || way.engine == Engine::loop) {
        return run_part(stage, way, state, u, y, samples);
    }
    const std::size_t values = stage.state_length(), length = samples / parts;
    std::vector<double> states, end(state, state + values);
    for (std::size_t part = 0; part < parts; ++part) {
        states.insert(states.end(), end.begin(), end.end());
        Lanes(stage).jump(end.data(), u + part * length, length);
    }
    std::vector<char> finite(parts);
    parallel(parts, threads, [&](std::size_t part) {
        const std::size_t first = part * length;
        const std::size_t count = part + 1 < parts ? length : samples - first;
        finite[part] = run_part(stage, way, &states[part * values], u + first, y + first, count);
    });
    for (std::size_t i = 0; i < values; ++i) state[i] = states[(parts - 1) * values + i];
    return std::find(finite.begin(), finite.end(), 0) == finite.end();
}

bool run_chain(const Chain &chain, double *state, const double *u, double *y, std::size_t samples,
               const Options &options, std::vector<Choice> *choices) {
    if (chain.stages().empty()) {
        std::copy(u, u + samples, y);
        return all_finite(u, samples);
    }
    const double *in = u;
    for (const Stage &stage : chain.stages()) {
        const Choice choice = choose(stage, state, in, samples, options.engine);
        if (choices != nullptr) choices->push_back(choice);
        // The last bits that the curve gives up must not decide on an overflow further on.
        const Way way{choice.engine, &stage == &chain.stages().back() ? kHuge : kModerate};
        if (!run_parts(stage, way, state, in, y, samples, options.threads)) return false;
        state += stage.state_length();
        in = y;
    }
    return true;
}

// Sample by sample as in real time. Returns the index of the first that overflows on its way, or
// how many there are.
std::size_t run_guarded(const Chain &chain, double *state, const double *u, double *y,
                        std::size_t samples) {
    const hyst_chain view = chain.view();
    hyst_guard guard{0.0, 0};
    for (std::size_t k = 0; k < samples; ++k) {
        y[k] = hyst_guarded_step(&view, state, &guard, u[k]);
        if (guard.fault) return k;
    }
    return samples;
}

void tell_of_core(const Chain &chain, std::vector<Choice> &choices) {
    choices.assign(chain.stages().size(),
                   {Engine::loop, "only the core's order tells what overflows", kNot, kNot, kNot, {}});
}

// Short records of a batch: as many as there are lanes go side by side.
bool runs_rows_in_lanes(const Chain &chain, const Options &options, std::size_t rows,
                        std::size_t samples) {
    constexpr std::size_t short_record = 4096;
    const bool allowed = options.engine == Engine::automatic || options.engine == Engine::lanes;
    return allowed && chain.stages().size() == 1 && Lanes::can_take(chain.stages()[0]) &&
           rows >= kernels().width && samples <= short_record;
}

}  // namespace

Choice choose(const Stage &stage, const double *state, const double *u, std::size_t samples,
              Engine wanted) {
    if (!Lanes::can_take(stage)) {
        const bool plays = stage.kind->plays != nullptr;
        return {Engine::loop, plays ? "its thresholds do not ascend from zero or more"
                                    : "it has no plays",
                kNot, kNot, kNot, {}};
    }
    Choice choice = estimate(stage, state, u, samples);
    if (wanted == Engine::automatic) {
        take_cheapest(choice, samples);
    } else if (wanted == Engine::memory_curve && curved_bank(stage, state) == nullptr) {
        choice.engine = Engine::lanes;
        choice.reason = "the memory curve cannot take this stage or this state";
    } else {
        choice.engine = wanted;
        choice.reason = "asked for";
    }
    return choice;
}

bool run_curve_in_place(const Stage &stage, double *state, double *y, std::size_t samples,
                        std::size_t threads) {
    const double room = headroom(*stage.kind->plays->bank(stage.model), state, kHuge);
    std::size_t beyond = 0;  // counted, for compilers do not put a maximum side by side
    for (std::size_t k = 0; k < samples; ++k) beyond += !(std::abs(y[k]) <= room);
    return beyond == 0 &&
           run_parts(stage, {Engine::memory_curve, kHuge, true}, state, y, y, samples, threads);
}

bool evaluate_stage(const Stage &stage, double *state, const double *u, double *y,
                    std::size_t samples, const Options &options) {
    if (samples == 0) return true;
    const Engine engine = choose(stage, state, u, samples, options.engine).engine;
    if (engine != Engine::memory_curve) {
        return run_parts(stage, {engine}, state, u, y, samples, options.threads);
    }
    const std::vector<double> before(state, state + stage.state_length());
    std::vector<double> copy;
    if (u == y) copy.assign(u, u + samples);
    const double *in = u == y ? copy.data() : u;
    if (run_parts(stage, {engine}, state, in, y, samples, options.threads)) return true;
    std::copy(before.begin(), before.end(), state);
    return run_parts(stage, {Engine::lanes}, state, in, y, samples, options.threads);
}

std::size_t evaluate(const Chain &chain, double *states, const double *u, double *y,
                     std::size_t rows, std::size_t samples, const Options &options,
                     std::vector<Choice> *choices) {
    const std::size_t total = rows * samples;
    if (total == 0) return total;
    const std::size_t length = chain.state_length();
    const bool side_by_side = runs_rows_in_lanes(chain, options, rows, samples) && !choices;
    const std::size_t together = side_by_side ? kernels().width : 1;
    const std::size_t groups = rows / together;
    const Options within{options.engine, rows > 1 ? 1 : options.threads};
    const std::vector<double> before(states, states + rows * length);

    const auto run_row = [&](std::size_t row) {
        return run_chain(chain, states + row * length, u + row * samples, y + row * samples,
                         samples, within, row == 0 ? choices : nullptr);
    };
    std::vector<char> finite(groups + 1, 1);
    parallel(groups, rows > 1 ? options.threads : 1, [&](std::size_t group) {
        const std::size_t row = group * together, k = row * samples;
        finite[group] = side_by_side ? Lanes(chain.stages()[0])
                                           .run_rows(states + row * length, u + k, y + k, samples)
                                     : run_row(row);
    });
    for (std::size_t row = groups * together; row < rows; ++row) {
        if (!run_row(row)) finite[groups] = 0;
    }
    if (std::find(finite.begin(), finite.end(), 0) == finite.end()) return total;
    std::copy(before.begin(), before.end(), states);
    std::size_t bad = kernels().first_non_finite(u, total);
    if (bad < total) return bad;
    // Something overflows, or may. The core's step says whether and where: sums in its order are what
    // counts, not those of the memory curve.
    if (choices != nullptr) tell_of_core(chain, *choices);
    for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t first = row * samples;
        const std::size_t taken =
            run_guarded(chain, states + row * length, u + first, y + first, samples);
        if (taken < samples) {
            std::copy(before.begin(), before.end(), states);
            return first + taken;
        }
    }
    return total;
}

}  // namespace hyst
