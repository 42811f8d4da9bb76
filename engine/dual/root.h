/* The square root with its derivative: HYST_ROOT_HEADER of hyst/root.h. At 0, where it has none, the
 * derivative counts as 0. */

HYST_INLINE hyst_real hyst_root(hyst_real x)
{
    const double root = ::hyst::core_root(x.v);
    if (!(root > 0.0)) {
        return root;
    }
    return {root, (0.5 / root) * x.d};
}
