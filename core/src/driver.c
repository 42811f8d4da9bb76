/* Codes and volts of a driver: the piece by bisection, the code by division, then by comparing. */
#include "hyst/driver.h"

/* Codes from one point of the table to another: as unsigned numbers, for the whole range has more than
 * a signed one. */
static uint32_t codes_between(int32_t from, int32_t to)
{
    return (uint32_t)to - (uint32_t)from;
}

static int is_before(const hyst_driver *driver, hyst_real volt, hyst_real other)
{
    return driver->volt[0] < driver->volt[1] ? volt < other : volt > other;
}

static hyst_real volt_in_piece(const hyst_driver *driver, size_t piece, uint32_t codes)
{
    const hyst_real end = driver->volt[piece + 1u];
    hyst_real volt;
    if (codes >= codes_between(driver->code[piece], driver->code[piece + 1u])) {
        return end;
    }
    volt = driver->volt[piece] + driver->slope[piece] * (hyst_real)codes;
    return is_before(driver, end, volt) ? end : volt;
}

hyst_real hyst_driver_volt(const hyst_driver *driver, int32_t code)
{
    size_t piece = 0u, beyond = driver->count - 1u;
    if (code <= driver->code[0]) {
        return driver->volt[0];
    }
    while (beyond - piece > 1u) {
        const size_t middle = piece + (beyond - piece) / 2u;
        if (code < driver->code[middle]) {
            beyond = middle;
        } else {
            piece = middle;
        }
    }
    if (code >= driver->code[beyond]) {
        return driver->volt[beyond];
    }
    return volt_in_piece(driver, piece, codes_between(driver->code[piece], code));
}

/* The piece in which a volt lies; the first or the last for one beyond the table. */
static size_t piece_of_volt(const hyst_driver *driver, hyst_real volt)
{
    size_t piece = 0u, beyond = driver->count - 1u;
    while (beyond - piece > 1u) {
        const size_t middle = piece + (beyond - piece) / 2u;
        if (is_before(driver, volt, driver->volt[middle]) != 0) {
            beyond = middle;
        } else {
            piece = middle;
        }
    }
    return piece;
}

/* The last code of a piece, counted from its start, that volt has passed; 0 if it has passed none. */
static uint32_t codes_passed(const hyst_driver *driver, size_t piece, hyst_real volt, uint32_t most)
{
    const hyst_real about = (volt - driver->volt[piece]) / driver->slope[piece];
    uint32_t codes = 0u;
    if (about >= (hyst_real)most) {
        codes = most;
    } else if (about > HYST_REAL(0.0)) {
        codes = (uint32_t)about;
    } else {
        codes = 0u;
    }
    /* Division and product round: the volts themselves decide. */
    while (codes > 0u && is_before(driver, volt, volt_in_piece(driver, piece, codes))) {
        --codes;
    }
    while (codes < most && !is_before(driver, volt, volt_in_piece(driver, piece, codes + 1u))) {
        ++codes;
    }
    return codes;
}

static hyst_real distance(hyst_real a, hyst_real b)
{
    return a < b ? b - a : a - b;
}

int32_t hyst_driver_code(const hyst_driver *driver, hyst_real volt)
{
    const size_t piece = piece_of_volt(driver, volt);
    const int32_t first = driver->code[piece];
    const uint32_t most = codes_between(first, driver->code[piece + 1u]);
    uint32_t codes = volt == volt ? codes_passed(driver, piece, volt, most) : 0u;
    if (codes < most && distance(volt, volt_in_piece(driver, piece, codes + 1u)) <
                            distance(volt, volt_in_piece(driver, piece, codes))) {
        ++codes;
    }
    /* Compared as distances from the first code, which no conversion of a large number precedes. */
    if (driver->lowest > first && codes <= codes_between(first, driver->lowest)) {
        return driver->lowest;
    }
    if (driver->highest <= first) {
        return driver->highest;
    }
    if (codes >= codes_between(first, driver->highest)) {
        return driver->highest;
    }
    return (int32_t)((int64_t)first + (int64_t)codes);
}
