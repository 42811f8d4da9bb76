// Samples that any bank of plays must answer alike, folded into one row: same input, same memory.
//
// What plays remember of an input is the sequence of those turns that later ones have not wiped out,
// each smaller than the one before. Samples whose input and turns agree to a quantum share a row of
// means. The quantum starts so small that equal inputs alone agree, and doubles while there are too
// many rows; an input that never repeats fills them, and then the oldest are given up. So memory is
// bounded: two pages of rows.
#ifndef HYST_ENGINE_PYTHON_FOLDED_HPP
#define HYST_ENGINE_PYTHON_FOLDED_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hyst {

// Turns that are kept; inner ones are dropped, which only ripple deeper than that shows.
inline constexpr std::size_t most_turns = 7;
// A page that never ends, and the samples of the first one.
inline constexpr double for_ever = 1e300, first_page = 1000.0;

struct FoldedRow {
    double count = 0.0, y = 0.0;
    double uu = 0.0, uy = 0.0, yy = 0.0;        // squares and products about the means, summed
    std::size_t size = 0;                       // of the way: turns from the outermost on, the input
    std::array<double, most_turns + 1> way{};

    double u() const { return way[size - 1]; }
};

class Folded {
public:
    // quantum: smallest difference that tells inputs apart; coarsest: where rows are given up;
    // page: samples after which a new page begins and the one before the last is given up; where
    // nothing is given up, the last page joins the one before once it has as many samples.
    Folded(double quantum, double coarsest, double most, double page)
        : finest_(quantum), quantum_(quantum), coarsest_(coarsest), most_(most), page_(page) {}

    // An input whose output was not measured.
    void follow(double u) {
        if (!std::isfinite(u)) return;
        if (turns_.empty()) {
            turns_.push_back(u);
            last_ = u;
            return;
        }
        if (u > last_ || u < last_) move(u);
    }

    void take(double u, double y) {
        follow(u);
        if (turned_ < 2 || !std::isfinite(y)) return;
        FoldedRow row;
        const std::size_t turns = std::min(turns_.size(), most_turns);
        std::copy_n(turns_.begin(), turns, row.way.begin());
        row.way[turns] = u;
        row.size = turns + 1;
        row.count = 1.0;
        row.y = y;
        add(row, rows_);
        on_page_ += 1.0;
        if (on_page_ >= page_) {
            turn_page();
        } else if (page_ >= for_ever && on_page_ >= before_samples_ && on_page_ >= first_page) {
            join();
        }
        if (static_cast<double>(rows_.size()) > most_) coarsen();
    }

    // Gives the rows up; the memory of the input stays.
    void clear() {
        rows_.clear();
        before_.clear();
        quantum_ = finest_;
        on_page_ = before_samples_ = 0.0;
    }

    // Rows of the present page and of the one before.
    std::vector<FoldedRow> page(bool before) const {
        std::vector<FoldedRow> found;
        for (const auto &each : before ? before_ : rows_) found.push_back(each.second);
        return found;
    }

    // Of both, as one.
    std::vector<FoldedRow> both() const {
        Rows joined = before_;
        for (const auto &each : rows_) add(each.second, joined);
        std::vector<FoldedRow> found;
        for (const auto &each : joined) found.push_back(each.second);
        return found;
    }

    // Where it stands, for a file.
    std::vector<double> place() const {
        std::vector<double> is = {last_, side_, turned_, quantum_, on_page_, before_samples_};
        is.insert(is.end(), turns_.begin(), turns_.end());
        return is;
    }
    void restore(const std::vector<double> &place, const std::vector<FoldedRow> &rows,
                 const std::vector<FoldedRow> &before) {
        last_ = place.at(0);
        side_ = place.at(1);
        turned_ = place.at(2);
        quantum_ = place.at(3);
        on_page_ = place.at(4);
        before_samples_ = place.at(5);
        turns_.assign(place.begin() + 6, place.end());
        rows_.clear();
        before_.clear();
        for (const FoldedRow &each : rows) add(each, rows_);
        for (const FoldedRow &each : before) add(each, before_);
    }

private:
    using Rows = std::unordered_map<std::uint64_t, FoldedRow>;

    void turn_page() {
        before_ = std::move(rows_);
        rows_.clear();
        before_samples_ = on_page_;
        on_page_ = 0.0;
    }
    void join() {
        for (const auto &each : rows_) add(each.second, before_);
        rows_.clear();
        before_samples_ += on_page_;
        on_page_ = 0.0;
        if (static_cast<double>(before_.size()) > most_) coarsen();
    }

    void move(double u) {
        const double side = u > last_ ? 1.0 : -1.0;
        if (side != side_) {
            // The first sample is where the input comes from, not a turn.
            if (side_ != 0.0) {
                turns_.push_back(last_);
                turned_ += 1.0;
            }
            side_ = side;
        }
        // Turns that the input passes again are forgotten with the one between.
        while (turns_.size() >= 2 && (u - turns_[turns_.size() - 2]) * side >= 0.0) {
            if (turns_.size() == 2) {
                turns_.erase(turns_.begin());
            } else {
                turns_.resize(turns_.size() - 2);
            }
        }
        last_ = u;
    }

    std::uint64_t key(const FoldedRow &row) const {
        std::uint64_t hash = 1469598103934665603ull;
        const double share = 1.0 / quantum_;
        for (std::size_t k = 0; k < row.size; ++k) {
            const auto step = static_cast<std::int64_t>(row.way[k] * share + 0.5);
            hash = (hash ^ static_cast<std::uint64_t>(step)) * 1099511628211ull;
            hash ^= hash >> 29;
        }
        return hash ^ (row.size * 0x9E3779B97F4A7C15ull);
    }

    void add(const FoldedRow &row, Rows &rows) const {
        FoldedRow &into = rows[key(row)];
        if (into.size != row.size) {
            into = row;
            return;
        }
        const double total = into.count + row.count, share = row.count / total;
        const double dy = row.y - into.y, du = row.u() - into.u();
        const double both = into.count * share;
        into.uu += row.uu + du * du * both;
        into.uy += row.uy + du * dy * both;
        into.yy += row.yy + dy * dy * both;
        into.y += share * dy;
        for (std::size_t k = 0; k < row.size; ++k) {
            into.way[k] += share * (row.way[k] - into.way[k]);
        }
        into.count = total;
    }

    void coarsen() {
        if (quantum_ * 2.0 > coarsest_) {
            if (static_cast<double>(before_.size()) > most_) before_.clear();
            turn_page();
            return;
        }
        while (static_cast<double>(std::max(rows_.size(), before_.size())) > 0.5 * most_ && quantum_ * 2.0 <= coarsest_) {
            quantum_ *= 2.0;
            rows_ = again(rows_);
            before_ = again(before_);
        }
    }
    Rows again(const Rows &rows) const {
        Rows found;
        for (const auto &each : rows) add(each.second, found);
        return found;
    }

    double finest_, quantum_, coarsest_, most_, page_, on_page_ = 0.0, before_samples_ = 0.0;
    std::vector<double> turns_;
    double last_ = 0.0, side_ = 0.0, turned_ = 0.0;
    Rows rows_, before_;
};

}  // namespace hyst

#endif
