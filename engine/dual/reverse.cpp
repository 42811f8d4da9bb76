// The core's stages with a tape, and the pass over a record: block by block from the last, each recorded
// from the state before it and gone back through, so that no more than a block is ever on the tape.
#include "reverse.hpp"

#include <algorithm>

#include "core.hpp"

#define HYST_OTHER_NUMBER
#include "kinds.inc"  // made by CMakeLists.txt: the files of engine/kinds

#include "given.hpp"

namespace hyst {
namespace HYST_KINDS {

thread_local Tape tape = {nullptr, 0, 0};

static thread_local std::vector<Entry> pages;

uint32_t grow(Tape &to, Entry entry)
{
    pages.resize(std::max<std::size_t>(4096, 2 * pages.size()));
    to.entries = pages.data();
    to.room = static_cast<uint32_t>(pages.size());
    to.entries[to.count] = entry;
    return to.count++;
}

namespace {

Tangent independent() { return {record(0.0, 0, 0.0, 0)}; }

// The derivatives of a number by every place on the tape. What nothing depends on is passed over: it
// may be of a branch that was not taken, with factors that are not finite.
class Adjoint {
public:
    double of(Tangent at) const { return by_place_[at.place]; }
    void add(Tangent at, double value) { by_place_[at.place] += value; }
    void prepare() { by_place_.resize(std::max<std::size_t>(by_place_.size(), tape.count), 0.0); }

    // From the end of the tape back to place `first`.
    void back_to(uint32_t first) {
        for (uint32_t i = tape.count; i-- > first;) {
            const double value = by_place_[i];
            if (value == 0.0) continue;
            const Entry &entry = tape.entries[i];
            if (entry.a != 0) by_place_[entry.a] += entry.by_a * value;
            if (entry.b != 0) by_place_[entry.b] += entry.by_b * value;
        }
    }
    void clear_from(uint32_t first) {
        std::fill(by_place_.begin() + first, by_place_.begin() + tape.count, 0.0);
    }

private:
    std::vector<double> by_place_;
};

// One stage on its way back.
class Way {
public:
    Way(const Kind &kind, const void *model, std::size_t length, const Cotangents &given)
        : step_(kind.core->step), model_(model), given_(given), shared_(tape.count),
          by_state_(length, 0.0) {}

    void back(Adjoint &adjoint) {
        for (std::size_t b = given_.blocks(); b-- > 0;) back_through(b, adjoint);
    }

private:
    void back_through(std::size_t b, Adjoint &adjoint) {
        const std::size_t first = b * given_.block, end = given_.end(b), length = by_state_.size();
        state_.clear();
        start_.clear();
        inputs_.clear();
        outputs_.clear();
        for (std::size_t i = 0; i < length; ++i) {
            start_.push_back(independent());
            state_.emplace_back(given_.states[b * length + i], start_.back());
        }
        for (std::size_t k = first; k < end; ++k) {
            inputs_.push_back(independent());
            outputs_.push_back(step_(model_, state_.data(), hyst_real(given_.u[k], inputs_.back())).d);
        }
        adjoint.prepare();
        for (std::size_t i = 0; i < length; ++i) adjoint.add(state_[i].d, by_state_[i]);
        for (std::size_t k = first; k < end; ++k) adjoint.add(outputs_[k - first], given_.signal[k]);
        adjoint.back_to(shared_);
        for (std::size_t i = 0; i < length; ++i) by_state_[i] = adjoint.of(start_[i]);
        for (std::size_t k = first; k < end; ++k) given_.signal[k] = adjoint.of(inputs_[k - first]);
        adjoint.clear_from(shared_);
        tape.count = shared_;
    }

    hyst_real (*step_)(const void *, hyst_real *, hyst_real);
    const void *model_;
    const Cotangents &given_;
    uint32_t shared_;  // up to here the tape is of the constants
    std::vector<double> by_state_;
    std::vector<hyst_real> state_;
    std::vector<Tangent> start_, inputs_, outputs_;
};

void start_tape() {
    tape.count = 0;
    independent();  // place 0: what depends on nothing
}

}  // namespace

void reverse(const Said &said, std::size_t length, const Cotangents &given) {
    start_tape();
    Given taped = given_of(said);
    std::vector<Tangent> own;
    for (hyst_real &constant : taped.constants) own.push_back(constant.d = independent());
    Constants made;
    const Kind &kind = *kind_named(said.kind);
    const void *model = build(kind, taped, made);
    Adjoint adjoint;
    Way(kind, model, length, given).back(adjoint);
    adjoint.prepare();
    adjoint.back_to(1);
    for (std::size_t c = 0; c < own.size(); ++c) given.by_constants[c] = adjoint.of(own[c]);
}

}  // namespace HYST_KINDS

void kernel_reverse(const Said &said, std::size_t length, const Cotangents &given) {
    HYST_KINDS::reverse(said, length, given);
}

}  // namespace hyst
