// Written against the C API of Python because a call through vectorcall costs half of what a bound
// C++ method costs, and this call is the whole point. Against its limited part, which one build of
// the module needs to serve every Python from 3.12.
#include "stepper.hpp"

#include <structmember.h>

#include <cstddef>
#include <cstring>

namespace hyst {
namespace {

struct Stepper {
    PyObject_HEAD
    PyObject *owner;
    PyObject *state_object;
    Py_buffer state;
    hyst_chain chain;
    hyst_guard guard;
    double y_safe;
    vectorcallfunc vectorcall;
};

PyTypeObject *stepper_type = nullptr;

PyObject *call(PyObject *self, PyObject *const *arguments, std::size_t flags, PyObject *names) {
    auto *stepper = reinterpret_cast<Stepper *>(self);
    if (PyVectorcall_NARGS(flags) != 1 || names != nullptr) {
        PyErr_SetString(PyExc_TypeError, "step(u) takes one number");
        return nullptr;
    }
    const double u = PyFloat_AsDouble(arguments[0]);
    if (u == -1.0 && PyErr_Occurred()) return nullptr;
    auto *state = static_cast<double *>(stepper->state.buf);
    return PyFloat_FromDouble(hyst_guarded_step(&stepper->chain, state, &stepper->guard, u));
}

PyObject *get_state(PyObject *self, void *) {
    PyObject *state = reinterpret_cast<Stepper *>(self)->state_object;
    Py_INCREF(state);
    return state;
}

PyObject *get_fault(PyObject *self, void *) {
    return PyBool_FromLong(reinterpret_cast<Stepper *>(self)->guard.fault);
}

PyObject *clear_fault(PyObject *self, PyObject *) {
    reinterpret_cast<Stepper *>(self)->guard.fault = 0;
    Py_RETURN_NONE;
}

void deallocate(PyObject *self) {
    auto *stepper = reinterpret_cast<Stepper *>(self);
    PyTypeObject *type = Py_TYPE(self);
    if (stepper->state.obj != nullptr) PyBuffer_Release(&stepper->state);
    Py_XDECREF(stepper->state_object);
    Py_XDECREF(stepper->owner);
    reinterpret_cast<freefunc>(PyType_GetSlot(type, Py_tp_free))(self);
    Py_DECREF(type);
}

PyGetSetDef properties[] = {
    {"state", get_state, nullptr, "The live state array; copy it to save, assign into it to restore.",
     nullptr},
    {"fault", get_fault, nullptr, "True since the first sample that was not finite.", nullptr},
    {nullptr, nullptr, nullptr, nullptr, nullptr}};

PyMethodDef methods[] = {{"clear_fault", clear_fault, METH_NOARGS, "Lower the fault flag."},
                         {nullptr, nullptr, 0, nullptr}};

PyMemberDef members[] = {{"__vectorcalloffset__", T_PYSSIZET, offsetof(Stepper, vectorcall),
                          READONLY, nullptr},
                         {nullptr, 0, 0, 0, nullptr}};

PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void *>(deallocate)},
                       {Py_tp_call, reinterpret_cast<void *>(PyVectorcall_Call)},
                       {Py_tp_getset, properties},
                       {Py_tp_methods, methods},
                       {Py_tp_members, members},
                       {Py_tp_doc, const_cast<char *>("step(u) -> y, one sample at a time")},
                       {0, nullptr}};

PyType_Spec spec = {"hyst._engine.Stepper", sizeof(Stepper), 0,
                    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_HAVE_VECTORCALL |
                        Py_TPFLAGS_DISALLOW_INSTANTIATION,
                    slots};

bool take_state(Stepper *stepper, PyObject *state, std::size_t length) {
    const int flags = PyBUF_WRITABLE | PyBUF_FORMAT | PyBUF_C_CONTIGUOUS;
    if (PyObject_GetBuffer(state, &stepper->state, flags) != 0) return false;
    const bool fits = stepper->state.format != nullptr &&
                      std::strcmp(stepper->state.format, "d") == 0 &&
                      static_cast<std::size_t>(stepper->state.len) == length * sizeof(double);
    if (!fits) PyErr_SetString(PyExc_ValueError, "the state must be float64 of the right length");
    return fits;
}

}  // namespace

PyObject *new_stepper(PyObject *owner, const Chain &chain, PyObject *state, double y_safe) {
    auto *stepper = reinterpret_cast<Stepper *>(PyType_GenericAlloc(stepper_type, 0));
    if (stepper == nullptr) return nullptr;
    stepper->vectorcall = call;
    if (!take_state(stepper, state, chain.state_length())) {
        Py_DECREF(stepper);
        return nullptr;
    }
    Py_INCREF(owner);
    stepper->owner = owner;
    Py_INCREF(state);
    stepper->state_object = state;
    stepper->chain = chain.view();
    stepper->guard = {y_safe, 0};
    return reinterpret_cast<PyObject *>(stepper);
}

bool register_stepper(PyObject *module) {
    PyObject *type = PyType_FromSpec(&spec);
    if (type == nullptr) return false;
    stepper_type = reinterpret_cast<PyTypeObject *>(type);
    return PyModule_AddObjectRef(module, "Stepper", type) == 0;
}

}  // namespace hyst
