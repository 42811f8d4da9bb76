// A callable for real time: one sample in, one sample out, no allocation but the result.
#pragma once

#include <Python.h>

#include "../chain.hpp"
#include "hyst/guard.h"

namespace hyst {

// `owner` is the Python object that owns `chain` and is kept alive; `state` is a writable,
// contiguous float64 buffer of chain.state_length() values, held and updated in place.
PyObject *new_stepper(PyObject *owner, const Chain &chain, PyObject *state, double y_safe);

// Creates the type and adds it to the module. Returns false with a Python error set.
bool register_stepper(PyObject *module);

}  // namespace hyst
