#include "gram.hpp"

#include <algorithm>

#include "hyst/play.h"

namespace hyst {
namespace {

void step_all(const std::vector<double> &r, double *z, double u) {
    for (std::size_t i = 0; i < r.size(); ++i) z[i] = hyst_play(u, r[i], z[i]);
}

// Add row row^T to the lower triangle.
void add_outer_product(const std::vector<double> &row, double *gram) {
    const std::size_t width = row.size();
    for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t j = 0; j <= i; ++j) gram[i * width + j] += row[i] * row[j];
    }
}

void mirror(std::size_t width, double *gram) {
    for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t j = 0; j < i; ++j) gram[j * width + i] = gram[i * width + j];
    }
}

}  // namespace

void play_gram(const std::vector<double> &r, double *z, const double *u, const double *y,
               const std::vector<std::size_t> &edges, double *gram) {
    const std::size_t n = r.size(), width = n + 3;
    std::vector<double> row(width, 1.0);
    for (std::size_t k = 0; k < edges.front(); ++k) step_all(r, z, u[k]);
    for (std::size_t block = 0; block + 1 < edges.size(); ++block, gram += width * width) {
        for (std::size_t k = edges[block]; k < edges[block + 1]; ++k) {
            step_all(r, z, u[k]);
            row[0] = u[k];
            std::copy(z, z + n, row.begin() + 1);
            row[n + 2] = y[k];
            add_outer_product(row, gram);
        }
        mirror(width, gram);
    }
}

void play_outputs(const std::vector<double> &r, double *z, const double *u, std::size_t samples,
                  double *outputs) {
    for (std::size_t k = 0; k < samples; ++k) {
        step_all(r, z, u[k]);
        std::copy(z, z + r.size(), outputs + k * r.size());
    }
}

}  // namespace hyst
