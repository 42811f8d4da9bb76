// A bank's output from its plays' products, in the order of hyst/bank.h.
#pragma once

#include <cstddef>

#include "hyst/bank.h"

namespace hyst {

// product(i) is p_i z_i.
template <class Product>
double bank_sum(std::size_t count, double first, const Product &product) {
    const std::size_t fours = count < HYST_WIDE_BANK ? 0 : count - count % 4;
    double y = first;
    if (fours > 0) {
        double s[4] = {};
        for (std::size_t i = 0; i < fours; ++i) s[i % 4] += product(i);
        y += (s[0] + s[2]) + (s[1] + s[3]);
    }
    for (std::size_t i = fours; i < count; ++i) y += product(i);
    return y;
}

}  // namespace hyst
