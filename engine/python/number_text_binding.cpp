#include "number_text_binding.hpp"

#include "../number_text.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace nb = nanobind;

namespace hyst {
namespace {

using Column = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Table = nb::ndarray<double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

nb::bytes rows_as_text(const std::vector<Column> &columns, std::size_t start, std::size_t stop) {
    std::vector<const double *> data;
    for (const Column &column : columns) {
        if (start > stop || stop > column.shape(0)) throw std::invalid_argument("rows out of range");
        data.push_back(column.data());
    }
    std::string text;
    {
        nb::gil_scoped_release released;
        append_rows(data, start, stop, text);
    }
    return nb::bytes(text.data(), text.size());
}

bool text_as_rows(const nb::bytes &text, std::size_t start, std::size_t stop,
                  const std::string &separator, const std::vector<std::size_t> &used, Table values) {
    if (start > stop || stop > text.size() || separator.size() > 1) {
        throw std::invalid_argument("text out of range");
    }
    std::vector<double *> targets(values.shape(0), nullptr);
    for (const std::size_t k : used) {
        if (k >= targets.size()) throw std::invalid_argument("column out of range");
        targets[k] = values.data() + k * values.shape(1);
    }
    const char *begin = text.c_str();
    const std::size_t rows = values.shape(1);
    nb::gil_scoped_release released;
    return parse_rows(begin + start, begin + stop, separator.empty() ? '\0' : separator[0], targets,
                      rows);
}

}  // namespace

void bind_number_text(nb::module_ &module) {
    module.def("has_number_text", &has_number_text);
    module.def("rows_as_text", &rows_as_text);
    module.def("text_as_rows", &text_as_rows);
}

}  // namespace hyst
