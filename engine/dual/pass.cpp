// Compiled once for every number of tangents and every instruction set beyond the baseline.
#include "pass.hpp"

namespace hyst {
namespace HYST_KINDS {

extern const Pass run_pass;

const Pass run_pass = pass;

}  // namespace HYST_KINDS
}  // namespace hyst
