/* x^e with its derivative, e x^(e-1) dx + ln(x) x^e de: HYST_POWER_HEADER of hyst/power.h.
 * The value has the core's bits. At 0 there is no derivative to speak of; it counts as 0. */
HYST_INLINE hyst_real hyst_power(hyst_real x, hyst_real e)
{
    const double power = ::hyst::core_power(x.v, e.v);
    if (!(x.v > 0.0)) {
        return power;
    }
    return {power, (e.v * power / x.v) * x.d + (power * ::log(x.v)) * e.d};
}
