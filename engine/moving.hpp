// A chain of the core whose constants follow a second signal.
//
// Constants of stages with one that is not the same at all knots are written into the structures of the
// core, where the second signal has changed; nothing is allocated for it. Invariant: `stages_` points into `made_`, which never
// moves after construction; so a Moving is neither copied nor moved.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <utility>
#include <vector>

#include "hyst/finite.h"
#include "hyst/guard.h"
#include "hyst/schedule.h"
#include "kinds/kind.hpp"

namespace hyst {

class Moving {
public:
    using Stages = std::vector<std::pair<const kinds::Kind *, kinds::Constants>>;

    // The knots, ascending, and the stages at each of them, which differ in nothing but constants.
    Moving(kinds::Reals at, const std::vector<Stages> &knots) : at_(std::move(at)) {
        if (knots.empty() || knots.size() != at_.size()) {
            throw std::invalid_argument("a schedule has one chain for every knot");
        }
        for (const auto &[kind, constants] : knots[0]) made_.push_back({kind, constants});
        std::vector<kinds::Reals> rows(knots.size());
        for (std::size_t i = 0; i < made_.size(); ++i) add(i, knots, rows);
        for (const kinds::Reals &row : rows) table_.insert(table_.end(), row.begin(), row.end());
        now_.resize(place_.size());
        schedule_ = {at_.size(), place_.size(), at_.data(), table_.data()};
        set(at_[0]);
    }
    Moving(const Moving &) = delete;
    Moving &operator=(const Moving &) = delete;

    // The stages with the constants of now.
    hyst_chain view() const { return {stages_.size(), stages_.data()}; }

    std::size_t state_length() const {
        const hyst_chain chain = view();
        return hyst_chain_state_length(&chain);
    }

    // Takes the constants at s; gives 1 where they are held at an end of the schedule.
    int set(hyst_real s) {
        if (!is_set_ || s != s_) {
            held_ = hyst_schedule_constants(&schedule_, s, now_.data());
            for (std::size_t i = 0; i < place_.size(); ++i) *place_[i] = now_[i];
            s_ = s;
            is_set_ = true;
        }
        return held_;
    }

    // A record of finite samples, y apart from u: the first sample that overflows, or `samples`; adds to
    // `held` how many are outside the schedule.
    std::size_t run(hyst_real *state, const hyst_real *u, const hyst_real *s, hyst_real *y,
                    std::size_t samples, std::size_t &held) {
        std::copy(u, u + samples, y);
        for (std::size_t first = 0; first < samples;) {
            std::size_t last = first + 1;
            while (last < samples && s[last] == s[first]) ++last;
            if (set(s[first]) != 0) held += last - first;
            hyst_real *memory = state;
            for (const hyst_stage &stage : stages_) {
                hyst_stage_run(&stage, memory, y + first, y + first, last - first);
                memory += hyst_stage_state_length(&stage);
                for (std::size_t k = first; k < last; ++k) {
                    if (!hyst_is_finite(y[k])) return k;
                }
            }
            first = last;
        }
        return samples;
    }

    // One sample, which may be anything; see hyst/guard.h.
    hyst_real step(hyst_real *state, hyst_guard *guard, int *outside, hyst_real u, hyst_real s) {
        if (hyst_is_finite(s)) {
            if (set(s) != 0) *outside = 1;
        } else {
            u = s;
        }
        const hyst_chain chain = view();
        return hyst_guarded_step(&chain, state, guard, u);
    }

private:
    void add(std::size_t i, const std::vector<Stages> &knots, std::vector<kinds::Reals> &rows) {
        bool moves = false;
        std::vector<kinds::Reals> own;
        for (const Stages &each : knots) {
            if (each.size() != made_.size() || each[i].first != made_[i].kind) {
                throw std::invalid_argument("the chains of a schedule have other stages");
            }
            own.emplace_back();
            for (const kinds::Constant &constant : each[i].second.all()) {
                own.back().insert(own.back().end(), constant.values.begin(), constant.values.end());
            }
            if (own.back().size() != own[0].size()) {
                throw std::invalid_argument("the chains of a schedule have other sizes");
            }
            moves = moves || own.back() != own[0];
        }
        stages_.push_back({made_[i].kind->core, made_[i].kind->fill(made_[i].constants)});
        if (!moves) return;
        const std::vector<hyst_real *> places = places_of(*made_[i].kind, made_[i].constants);
        place_.insert(place_.end(), places.begin(), places.end());
        for (std::size_t k = 0; k < knots.size(); ++k) {
            rows[k].insert(rows[k].end(), own[k].begin(), own[k].end());
        }
    }

    // Where the structure of a stage, already filled, has its constants: entries of tables in those that it
    // points to, numbers in itself, found by filling it with numbers that nothing else is.
    static std::vector<hyst_real *> places_of(const kinds::Kind &kind, kinds::Constants &constants) {
        std::vector<hyst_real *> places;
        for (kinds::Constant &each : constants.changeable()) {
            if (each.is_table) {
                for (hyst_real &value : each.values) places.push_back(&value);
                continue;
            }
            const hyst_real own = each.values[0];
            each.values[0] = hyst_real(-8.09017e-21);
            void *const model = const_cast<void *>(kind.fill(constants));
            hyst_real *found = nullptr;
            auto *const first = static_cast<unsigned char *>(model);
            for (std::size_t at = 0; at + sizeof(hyst_real) <= constants.model_size();
                 at += sizeof(hyst_real)) {
                if (std::memcmp(first + at, &each.values[0], sizeof(hyst_real)) == 0) {
                    if (found != nullptr) throw std::logic_error("a constant is there twice");
                    found = reinterpret_cast<hyst_real *>(first + at);
                }
            }
            each.values[0] = own;
            kind.fill(constants);
            if (found == nullptr) throw std::logic_error("a constant is in no structure");
            places.push_back(found);
        }
        return places;
    }

    kinds::Reals at_, table_, now_;
    std::deque<kinds::Inside> made_;
    std::vector<hyst_stage> stages_;
    std::vector<hyst_real *> place_;
    hyst_schedule schedule_{};
    hyst_real s_{};
    bool is_set_ = false;
    int held_ = 0;
};

}  // namespace hyst
