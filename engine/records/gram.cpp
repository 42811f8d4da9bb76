#include "gram.hpp"

#include <algorithm>

#include "hyst/play.h"
#include "../simd/kernels.hpp"

namespace hyst {
namespace {

// A bank whose arrays are padded to whole packs of the widest instruction set. The padding's plays
// have threshold 0; nobody reads them.
struct PaddedBank {
    std::size_t plays, stride;
    std::vector<double> r, z;

    PaddedBank(const std::vector<double> &thresholds, const double *start, std::size_t columns)
        : plays(thresholds.size()),
          stride((columns + kWidest - 1) / kWidest * kWidest),
          r(stride, 0.0),
          z(stride, 0.0) {
        for (std::size_t i = 0; i < plays; ++i) r[i] = thresholds[i];
        for (std::size_t i = 0; i < plays; ++i) z[i] = start[i];
    }
};

// From the columns z_1 .. z_n, u, 1, y as they are summed to u, z_1 .. z_n, 1, y, both triangles.
void write_out(const std::vector<double> &sums, std::size_t stride, std::size_t plays,
               double *gram) {
    const std::size_t width = plays + 3;
    const auto column = [&](std::size_t i) {
        return i == 0 ? plays : i <= plays ? i - 1 : i;
    };
    for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t j = 0; j < width; ++j) {
            const std::size_t a = column(i), b = column(j);
            gram[i * width + j] = sums[std::max(a, b) * stride + std::min(a, b)];
        }
    }
}

}  // namespace

void play_gram(const std::vector<double> &r, double *z, const double *u, const double *y,
               const std::vector<std::size_t> &edges, double *gram) {
    const Kernels &fast = kernels();
    const std::size_t n = r.size(), width = n + 3;
    PaddedBank bank(r, z, width);
    const std::size_t stride = bank.stride;
    std::vector<double> rows(kGramBlock * stride), sums(stride * stride);
    const auto fill_rows = [&](std::size_t first, std::size_t count) {
        fast.play_rows(bank.r.data(), bank.z.data(), stride, u + first, count, rows.data());
        for (std::size_t k = 0; k < count; ++k) {
            double *beyond = &rows[k * stride + n];
            beyond[0] = u[first + k];
            beyond[1] = 1.0;
            beyond[2] = y[first + k];
        }
    };

    for (std::size_t k = 0; k < edges.front(); k += kGramBlock) {
        fill_rows(k, std::min(kGramBlock, edges.front() - k));
    }
    for (std::size_t block = 0; block + 1 < edges.size(); ++block, gram += width * width) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (std::size_t k = edges[block]; k < edges[block + 1]; k += kGramBlock) {
            const std::size_t count = std::min(kGramBlock, edges[block + 1] - k);
            fill_rows(k, count);
            fast.add_gram(rows.data(), count, width, stride, sums.data());
        }
        write_out(sums, stride, n, gram);
    }
    std::copy(bank.z.begin(), bank.z.begin() + static_cast<std::ptrdiff_t>(n), z);
}

void play_outputs(const std::vector<double> &r, double *z, const double *u, std::size_t samples,
                  double *outputs) {
    const std::size_t n = r.size();
    PaddedBank bank(r, z, n);
    std::vector<double> rows(kGramBlock * bank.stride);
    for (std::size_t k = 0; k < samples; k += kGramBlock) {
        const std::size_t count = std::min(kGramBlock, samples - k);
        kernels().play_rows(bank.r.data(), bank.z.data(), bank.stride, u + k, count, rows.data());
        for (std::size_t row = 0; row < count; ++row) {
            std::copy_n(&rows[row * bank.stride], n, outputs + (k + row) * n);
        }
    }
    std::copy(bank.z.begin(), bank.z.begin() + static_cast<std::ptrdiff_t>(n), z);
}

}  // namespace hyst
