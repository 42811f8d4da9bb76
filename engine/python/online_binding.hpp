// What Python sees of estimation while the system runs.
#pragma once

#include <nanobind/nanobind.h>

namespace hyst {

void bind_online_estimation(nanobind::module_ &module);
void bind_radius_estimation(nanobind::module_ &module);
void bind_scale_estimation(nanobind::module_ &module);

}  // namespace hyst
