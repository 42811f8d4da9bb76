// Normal equations of the weights of a play bank, summed while the record streams by.
#pragma once

#include <cstddef>
#include <vector>

namespace hyst {

// Columns: u, z_1 .. z_n, 1, y. For block b the symmetric matrix of their inner products over the
// samples edges[b] <= k < edges[b + 1]; y[k] belongs to u[k]. gram: blocks x (n + 3) x (n + 3).
void play_gram(const std::vector<double> &r, double *z, const double *u, const double *y,
               const std::vector<std::size_t> &edges, double *gram);

// The play outputs themselves: samples x n, row-major.
void play_outputs(const std::vector<double> &r, double *z, const double *u, std::size_t samples,
                  double *outputs);

}  // namespace hyst
