// A small matrix, as a closed loop multiplies it.
#pragma once

#include <cstddef>
#include <vector>

#include "../simd/kernels.hpp"

namespace hyst {

// Rows of zeros fill up to a multiple of four, so sums has rows() entries.
class Product {
public:
    // at(i, j): the entry of row i and column j.
    template <class Entry>
    Product(std::size_t rows, std::size_t columns, const Entry &at)
        : rows_((rows + 3) / 4 * 4), values_(rows_ * columns, 0.0), add_(kernels().add_columns) {
        for (std::size_t i = 0; i < rows; ++i) {
            for (std::size_t j = 0; j < columns; ++j) values_[j * rows_ + i] = at(i, j);
        }
    }
    std::size_t rows() const { return rows_; }
    double at(std::size_t i, std::size_t j) const { return values_[j * rows_ + i]; }
    void set(double *sums, const double *z, std::size_t count, Begin begin) const {
        add_(values_.data(), rows_, z, count, begin, sums);
    }
    void add_column(double *sums, std::size_t j, double z) const {
        add_(values_.data() + j * rows_, rows_, &z, 1, Begin::from_sums, sums);
    }

private:
    std::size_t rows_;
    std::vector<double> values_;
    decltype(Kernels::add_columns) add_;
};

}  // namespace hyst
