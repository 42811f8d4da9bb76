/* Power, logarithm and exponential with their derivatives: HYST_POWER_HEADER of hyst/power.h. */

#define HYST_LN2 0.6931471805599453

HYST_INLINE hyst_real hyst_log2(hyst_real x)
{
    return {::hyst::core_log2(x.v), x.d / (HYST_LN2 * x.v)};
}

HYST_INLINE hyst_real hyst_exp2(hyst_real v)
{
    const double power = ::hyst::core_exp2(v.v);
    return {power, (HYST_LN2 * power) * v.d};
}

/* x^e with its derivative, e x^(e-1) dx + ln(x) x^e de.
 * The value has the core's bits. At 0 there is no derivative to speak of; it counts as 0. */
HYST_INLINE hyst_real hyst_power(hyst_real x, hyst_real e)
{
    const double power = ::hyst::core_power(x.v, e.v);
    if (!(x.v > 0.0)) {
        return power;
    }
    return {power, (e.v * power / x.v) * x.d + (power * ::log(x.v)) * e.d};
}
