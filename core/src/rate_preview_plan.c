/* One damped Gauss-Newton step on the plan of a preview. */
#include "hyst/play.h"
#include "hyst/rate_preview.h"

/* The scratch of a step, by what it holds. */
typedef struct {
    hyst_real *z;      /* play outputs, corners rounded */
    hyst_real *kept;   /* share of a play's output that is its last one: 0 in contact, 1 at rest */
    hyst_real *before; /* its derivative by the previous command */
    hyst_real *now;    /* and by the present one */
    hyst_real *rested; /* kept, one sample before */
    hyst_real *held;   /* derivatives of play i by command c, held[c * count + i] */
    hyst_real *row;    /* derivatives of the sample's output by the commands up to it */
    hyst_real *slope;  /* gradient of half the cost */
    hyst_real *step;
    hyst_real *trial;
    hyst_real *normal; /* normal equations, upper triangle, column after column */
} preview_scratch;

typedef struct {
    const hyst_rate_preview *model;
    const hyst_preview_stage *stage;
    const hyst_real *state; /* of the model */
    const hyst_real *target;
    hyst_real end; /* where the last command should be */
    size_t length;
} preview_problem;

static preview_scratch preview_scratch_of(hyst_real *free, size_t count, size_t length)
{
    preview_scratch own;
    own.z = free;
    own.kept = own.z + count;
    own.before = own.kept + count;
    own.now = own.before + count;
    own.rested = own.now + count;
    own.held = own.rested + count;
    own.row = own.held + count * length;
    own.slope = own.row + length;
    own.step = own.slope + length;
    own.trial = own.step + length;
    own.normal = own.trial + length;
    return own;
}

hyst_preview_places hyst_preview_layout(const hyst_rate_preview *model)
{
    const size_t count = model->plays.pi.count;
    const size_t length = model->preview + 1u;
    hyst_preview_places at;
    at.guess = count + 2u;
    at.scalars = at.guess + count + 2u;
    at.target = at.scalars + HYST_PREVIEW_SCALARS;
    at.start = at.target + length;
    at.plan = at.start + length;
    at.rival = at.plan + length;
    at.scratch = at.rival + length;
    at.end = at.scratch + count * (length + 5u) + 4u * length + (length * (length + 1u)) / 2u;
    return at;
}

static hyst_real *preview_column(const preview_scratch *own, size_t c)
{
    return own->normal + (c * (c + 1u)) / 2u;
}

/* The widening of a change and its slope, the corner at rest rounded. */
static hyst_real preview_widening(const preview_problem *of, hyst_real change, hyst_real *slope)
{
    const hyst_rate_dependent_pi *plays = &of->model->plays;
    const hyst_real width = of->stage->rate;
    hyst_real way = change < HYST_REAL(0.0) ? -change : change;
    hyst_real side = change < HYST_REAL(0.0) ? HYST_REAL(-1.0) : HYST_REAL(1.0);
    if (way < width) {
        side = change / width;
        way = HYST_REAL(0.5) * (way * way / width + width);
    }
    hyst_real growth = plays->growth;
    hyst_real power = way;
    for (size_t m = 0; m < plays->powers; ++m) {
        growth += (hyst_real)(m + 2u) * plays->power[m] * power;
        power *= way;
    }
    for (size_t j = 0; j < plays->ramps.count; ++j) {
        if (way > plays->ramps.threshold[j]) {
            growth += plays->ramps.weight[j];
        }
    }
    *slope = side * growth;
    return hyst_widening(plays, way);
}

/* Moves all rounded plays by one sample and gives the output. */
static hyst_real preview_move(const preview_problem *of, const preview_scratch *own, hyst_real u,
                              hyst_real widening)
{
    const hyst_pi *pi = &of->model->plays.pi;
    const size_t count = pi->count;
    const hyst_real c = of->stage->contact;
    const hyst_real share = HYST_REAL(0.25) / c;
    const hyst_real low = u - widening;
    const hyst_real high = u + widening;
    const hyst_real *p = pi->p;
    const hyst_real *r = pi->r;
    hyst_real *z = own->z;
    hyst_real *lifts = own->now;
    hyst_real *drops = own->before;
    hyst_real y = pi->p0 * u;
    for (size_t i = 0; i < count; ++i) {
        const hyst_real last = z[i];
        const hyst_real under = (low - r[i]) - last;
        const hyst_real lift = hyst_clamp(-c, c, under) + c;
        const hyst_real raised = last + ((under - HYST_SELECT(under < c, under, c)) + lift * lift * share);
        const hyst_real over = raised - (high + r[i]);
        const hyst_real drop = hyst_clamp(-c, c, over) + c;
        const hyst_real moved = raised - ((over - HYST_SELECT(over < c, over, c)) + drop * drop * share);
        z[i] = moved;
        lifts[i] = lift;
        drops[i] = drop;
        y += p[i] * moved;
    }
    return y;
}

/* From how far a play was lifted and dropped to its derivatives. */
static void preview_derive(const preview_problem *of, const preview_scratch *own, hyst_real slope)
{
    const hyst_real one = HYST_REAL(1.0);
    const hyst_real share = HYST_REAL(0.5) / of->stage->contact;
    const size_t count = of->model->plays.pi.count;
    for (size_t i = 0; i < count; ++i) {
        const hyst_real lift = own->now[i] * share;
        const hyst_real drop = own->before[i] * share;
        const hyst_real lifted = (one - drop) * lift;
        own->kept[i] = (one - lift) * (one - drop);
        own->now[i] = lifted * (one - slope) + drop * (one + slope);
        own->before[i] = (lifted - drop) * slope;
    }
}

/* Carries the derivatives of all plays over sample k and gives those of its output. */
static void preview_carry(const preview_problem *of, const preview_scratch *own, size_t k)
{
    const hyst_pi *pi = &of->model->plays.pi;
    const size_t count = pi->count;
    const hyst_real zero = HYST_REAL(0.0);
    /* A play that was in contact depends on the last two commands alone. */
    const size_t recent = k < 2u ? 0u : k - 2u;
    size_t first = recent;
    for (size_t i = 0; i < count; ++i) {
        if (own->kept[i] < HYST_REAL(1.0)) {
            const size_t from = own->rested[i] > zero ? 0u : recent;
            first = from < first ? from : first;
            for (size_t c = from; c < k; ++c) {
                own->held[c * count + i] *= own->kept[i];
            }
        }
        if (k > 0u) {
            own->held[(k - 1u) * count + i] += own->before[i];
        }
        own->held[k * count + i] = own->now[i];
        own->rested[i] = own->kept[i];
    }
    for (size_t c = first; c <= k; ++c) {
        hyst_real sum = zero;
        for (size_t i = 0; i < count; ++i) {
            sum += pi->p[i] * own->held[c * count + i];
        }
        own->row[c] = sum;
    }
}

/* Adds the squared error of sample k to gradient and normal equations. */
static void preview_count_error(const preview_scratch *own, size_t k, hyst_real p0, hyst_real error)
{
    const hyst_real by_plays = own->row[k];
    own->row[k] += p0;
    size_t first = 0;
    while (first < k && !(own->row[first] < HYST_REAL(0.0)) && !(own->row[first] > HYST_REAL(0.0))) {
        ++first;
    }
    for (size_t d = first; d <= k; ++d) {
        const hyst_real by_d = own->row[d];
        if (by_d < HYST_REAL(0.0) || by_d > HYST_REAL(0.0)) {
            hyst_real *column = preview_column(own, d);
            for (size_t c = first; c <= d; ++c) {
                column[c] += by_d * own->row[c];
            }
            own->slope[d] += by_d * error;
        }
    }
    own->row[k] = by_plays;
}

/* Adds weight (a u_k + b u_{k-1} + c u_{k-2})^2, whose root is `value` now; k - 1 and k - 2 only
 * where their factors are not 0. */
static void preview_count(const preview_scratch *own, size_t k, const hyst_real *factor, size_t terms,
                          hyst_real weight, hyst_real value)
{
    for (size_t a = 0; a < terms; ++a) {
        hyst_real *column = preview_column(own, k - a);
        own->slope[k - a] += weight * factor[a] * value;
        for (size_t b = a; b < terms; ++b) {
            column[k - b] += weight * factor[a] * factor[b];
        }
    }
}

static hyst_real preview_excess(hyst_real low, hyst_real high, hyst_real value)
{
    return value - hyst_clamp(low, high, value);
}

/* Cost of what a plan does beside its error at sample k; counted into the equations if asked to. */
static hyst_real preview_manners(const preview_problem *of, const preview_scratch *own,
                                 const hyst_real *u, size_t k, hyst_real change, int counted)
{
    static const hyst_real bend[3] = {HYST_REAL(1.0), HYST_REAL(-2.0), HYST_REAL(1.0)};
    static const hyst_real difference[2] = {HYST_REAL(1.0), HYST_REAL(-1.0)};
    const hyst_rate_preview *model = of->model;
    const hyst_real whole = of->stage->gain * of->stage->gain;
    const hyst_real much = HYST_REAL(100.0) * whole;
    hyst_real cost = HYST_REAL(0.0);
    if (k > 1u) {
        const hyst_real value = (u[k] - u[k - 1u]) - (u[k - 1u] - u[k - 2u]);
        cost += of->stage->roughness * value * value;
        if (counted != 0) {
            preview_count(own, k, bend, 3u, of->stage->roughness, value);
        }
    }
    if (k + 1u == of->length) {
        const hyst_real value = u[k] - of->end;
        cost += whole * value * value;
        if (counted != 0) {
            preview_count(own, k, difference, 1u, whole, value);
        }
    }
    if (model->ranged != 0) {
        const hyst_real value = preview_excess(model->low, model->high, u[k]);
        cost += much * value * value;
        if (counted != 0 && (value > HYST_REAL(0.0) || value < HYST_REAL(0.0))) {
            preview_count(own, k, difference, 1u, much, value);
        }
    }
    if (model->slowed != 0) {
        const hyst_real value = preview_excess(-model->change, model->change, change);
        cost += much * value * value;
        if (counted != 0 && (value > HYST_REAL(0.0) || value < HYST_REAL(0.0))) {
            preview_count(own, k, difference, k > 0u ? 2u : 1u, much, value);
        }
    }
    return cost;
}

/* Simulates a plan; gives its cost and, if asked to, gradient and normal equations. */
static hyst_real preview_walk(const preview_problem *of, const preview_scratch *own,
                              const hyst_real *u, int counted)
{
    const hyst_pi *pi = &of->model->plays.pi;
    const size_t count = pi->count;
    for (size_t i = 0; i < count; ++i) {
        own->z[i] = of->state[i];
        own->rested[i] = HYST_REAL(0.0);
    }
    hyst_real cost = HYST_REAL(0.0);
    for (size_t k = 0; k < of->length; ++k) {
        const int moved = k > 0u || of->state[count + 1u] > HYST_REAL(0.0);
        const hyst_real change = moved != 0 ? u[k] - (k > 0u ? u[k - 1u] : of->state[count])
                                            : HYST_REAL(0.0);
        hyst_real slope = HYST_REAL(0.0);
        hyst_real widening = HYST_REAL(0.0);
        if (moved != 0) {
            widening = preview_widening(of, change, &slope);
        }
        const hyst_real error = preview_move(of, own, u[k], widening) - of->target[k];
        cost += error * error;
        if (counted != 0) {
            preview_derive(of, own, slope);
            preview_carry(of, own, k);
            preview_count_error(own, k, pi->p0, error);
        }
        cost += preview_manners(of, own, u, k, change, counted);
    }
    return cost;
}

/* Solves the normal equations, the last command first: what comes late depends on little that comes
 * early, so that columns stay as empty as they are. */
static void preview_solve(const preview_scratch *own, size_t length, hyst_real damping)
{
    const hyst_real zero = HYST_REAL(0.0);
    for (size_t j = length; j > 0u; --j) {
        hyst_real *column = preview_column(own, j - 1u);
        const hyst_real inverse = HYST_REAL(1.0) / (column[j - 1u] + damping);
        column[j - 1u] = inverse;
        for (size_t i = 0; i + 1u < j; ++i) {
            if (column[i] < zero || column[i] > zero) {
                const hyst_real share = column[i] * inverse;
                hyst_real *other = preview_column(own, i);
                for (size_t k = 0; k <= i; ++k) {
                    other[k] -= share * column[k];
                }
                own->slope[i] -= share * own->slope[j - 1u];
            }
        }
    }
    for (size_t j = 0; j < length; ++j) {
        const hyst_real *column = preview_column(own, j);
        hyst_real left = -own->slope[j];
        for (size_t i = 0; i < j; ++i) {
            left -= column[i] * own->step[i];
        }
        own->step[j] = left * column[j];
    }
}

/* Empties the sums of a walk, and all that lies between slope and the end of the normal matrix. */
static void preview_clear(const preview_scratch *own, size_t count, size_t length)
{
    for (size_t i = 0; i < count * length; ++i) {
        own->held[i] = HYST_REAL(0.0);
    }
    for (size_t i = 0; i < 3u * length + (length * (length + 1u)) / 2u; ++i) {
        own->slope[i] = HYST_REAL(0.0);
    }
}

hyst_real hyst_preview_improve(const hyst_rate_preview *model, const hyst_preview_places *at,
                               hyst_real *state, size_t length, const hyst_preview_stage *stage,
                               hyst_real *plan, hyst_real *damping)
{
    const hyst_real least = HYST_REAL(1e-4);
    const hyst_real most = HYST_REAL(1e6);
    const preview_scratch own =
        preview_scratch_of(state + at->scratch, model->plays.pi.count, length);
    const preview_problem of = {model, stage, state, state + at->target,
                                state[at->start + length - 1u], length};
    preview_clear(&own, model->plays.pi.count, length);
    const hyst_real cost = preview_walk(&of, &own, plan, 1);
    preview_solve(&own, length, *damping * (stage->gain * stage->gain));
    hyst_real share = HYST_REAL(1.0);
    for (size_t tried = 0; tried < 2u; ++tried) {
        for (size_t k = 0; k < length; ++k) {
            own.trial[k] = plan[k] + share * own.step[k];
        }
        const hyst_real reached = preview_walk(&of, &own, own.trial, 0);
        if (reached < cost) {
            for (size_t k = 0; k < length; ++k) {
                plan[k] = own.trial[k];
            }
            if (tried == 0u) {
                const hyst_real less = HYST_REAL(0.3) * *damping;
                *damping = less > least ? less : least;
            }
            return reached;
        }
        share = HYST_REAL(0.25);
    }
    const hyst_real more = HYST_REAL(4.0) * *damping;
    *damping = more < most ? more : most;
    return cost;
}
