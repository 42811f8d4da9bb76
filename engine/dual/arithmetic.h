/* What numbers with derivatives have in common, whatever their Tangent is: sums, factors without a
 * derivative, comparisons by value. Included by real.h and tape.h, after the products of two. */
HYST_INLINE hyst_real operator-(hyst_real a) { return {-a.v, -a.d}; }
HYST_INLINE hyst_real operator+(hyst_real a, hyst_real b) { return {a.v + b.v, a.d + b.d}; }
HYST_INLINE hyst_real operator-(hyst_real a, hyst_real b) { return {a.v - b.v, a.d - b.d}; }
/* What has no derivative makes no product with one: 0 times an infinity would be a NaN. */
HYST_INLINE hyst_real operator*(double a, hyst_real b) { return {a * b.v, a * b.d}; }
HYST_INLINE hyst_real operator*(hyst_real a, double b) { return b * a; }
HYST_INLINE hyst_real operator/(hyst_real a, double b) { return {a.v / b, a.d / b}; }
HYST_INLINE hyst_real &operator+=(hyst_real &a, hyst_real b) { return a = a + b; }
HYST_INLINE hyst_real &operator-=(hyst_real &a, hyst_real b) { return a = a - b; }
HYST_INLINE hyst_real &operator*=(hyst_real &a, hyst_real b) { return a = a * b; }
HYST_INLINE hyst_real &operator/=(hyst_real &a, hyst_real b) { return a = a / b; }
HYST_INLINE bool operator<(const hyst_real &a, const hyst_real &b) { return a.v < b.v; }
HYST_INLINE bool operator>(const hyst_real &a, const hyst_real &b) { return a.v > b.v; }
HYST_INLINE bool operator<=(const hyst_real &a, const hyst_real &b) { return a.v <= b.v; }
HYST_INLINE bool operator>=(const hyst_real &a, const hyst_real &b) { return a.v >= b.v; }
HYST_INLINE bool operator==(const hyst_real &a, const hyst_real &b) { return a.v == b.v; }
HYST_INLINE bool operator!=(const hyst_real &a, const hyst_real &b) { return a.v != b.v; }
