/* Everything the core offers. See each header for its equations. */
#ifndef HYST_HYST_H
#define HYST_HYST_H

#include "hyst/chain.h"
#include "hyst/dead_zone.h"
#include "hyst/finite.h"
#include "hyst/guard.h"
#include "hyst/isotonic.h"
#include "hyst/joint_estimator.h"
#include "hyst/joint_parts.h"
#include "hyst/joint_search.h"
#include "hyst/linear_dynamics.h"
#include "hyst/loading_curve.h"
#include "hyst/masing.h"
#include "hyst/memory_element.h"
#include "hyst/play.h"
#include "hyst/power.h"
#include "hyst/prandtl_ishlinskii.h"
#include "hyst/radius_estimator.h"
#include "hyst/rate_dependent_prandtl_ishlinskii.h"
#include "hyst/real.h"
#include "hyst/tracking_controller.h"
#include "hyst/ud_factor.h"

#endif
