/* Runs an exported model over a record and reports its outputs, instructions, stack and state.
 *
 * vectors.h, which the runner writes, gives the model's `number` and a `word` of as many bits, SAMPLES,
 * INPUTS for each of them, their bits, and `step`: how they enter the model. Every line of the report is a word and a number, in hexadecimal. */
#include "board.h"
#include "stage.h"

#include "vectors.h"

typedef union {
    word bits;
    number value;
} pattern;

#define PAINT 0xA5C35A3Cu

/* In static memory, so that all of the stack below is the step's. */
static stage_state state;
static number y[SAMPLES];
static number again[SAMPLES];
static uint32_t ticks[SAMPLES];
static unsigned char saved[STAGE_SAVED_BYTES];

static inline number input(size_t k, size_t of)
{
    pattern u;
    u.bits = input_bits[k * INPUTS + of];
    return u.value;
}

static void write_number(word value)
{
    char text[2 * sizeof(word) + 2];
    size_t place = sizeof text;
    text[--place] = '\0';
    do {
        text[--place] = "0123456789abcdef"[value & 15u];
        value >>= 4;
    } while (value != 0u);
    text[--place] = ' ';
    board_write(text + place);
}

static void report(const char *what, word value)
{
    board_write(what);
    write_number(value);
    board_write("\n");
}

static inline uintptr_t stack_pointer(void)
{
    uintptr_t sp = 0;
#ifdef __arm__
    __asm__ volatile("mov %0, sp" : "=r"(sp));
#endif
    return sp;
}

/* Outputs, and the bytes of stack that were written below this function's own frame. No function is
 * called to paint or to look, for its frame would be found. */
static __attribute__((noinline)) uint32_t run_for_stack(void)
{
    const uintptr_t limit = board_stack_limit();
    const uintptr_t sp = limit == 0u ? 0u : stack_pointer();
    const volatile uint32_t *clean = (const volatile uint32_t *)limit;
    for (volatile uint32_t *place = (volatile uint32_t *)limit; (uintptr_t)place < sp; ++place) {
        *place = PAINT;
    }
    for (size_t k = 0; k < SAMPLES; ++k) {
        number u[INPUTS];
        for (size_t i = 0; i < INPUTS; ++i) {
            u[i] = input(k, i);
        }
        y[k] = step(&state, u);
    }
    while ((uintptr_t)clean < sp && *clean == PAINT) {
        ++clean;
    }
    return (uint32_t)(sp - (uintptr_t)clean);
}

typedef number (*call)(stage_state *, const number *);

static number nothing(stage_state *unused, const number *u)
{
    (void)unused;
    return u[INPUTS - 1];
}

/* Ticks of a call, and of what surrounds it. */
static __attribute__((noinline)) uint32_t ticks_of(call work, const number *u, number *result)
{
    const uint32_t start = board_ticks();
    *result = work(&state, u);
    return (board_ticks() - start) & 0x00FFFFFFu;
}

static __attribute__((noinline)) uint32_t ticks_of_plain(void (*work)(void))
{
    const uint32_t start = board_ticks();
    work();
    return (board_ticks() - start) & 0x00FFFFFFu;
}

static void run_for_ticks(void)
{
    for (size_t k = 0; k < SAMPLES; ++k) {
        number u[INPUTS];
        for (size_t i = 0; i < INPUTS; ++i) {
            u[i] = input(k, i);
        }
        ticks[k] = ticks_of(step, u, &again[k]);
    }
}

/* Half the record, then the other half from a state that went through its saved bytes. */
static int differs_after_saving(void)
{
    int differs = 0;
    stage_init(&state);
    for (size_t k = 0; k < SAMPLES; ++k) {
        number u[INPUTS];
        pattern one, two;
        for (size_t i = 0; i < INPUTS; ++i) {
            u[i] = input(k, i);
        }
        if (k == SAMPLES / 2) {
            stage_state_save(&state, saved);
            stage_init(&state);
            differs |= stage_state_load(&state, saved) != 0;
        }
        one.value = step(&state, u);
        two.value = y[k];
        differs |= one.bits != two.bits;
    }
    return differs;
}

int main(void)
{
    number unused;
    const number zeros[INPUTS] = {0};
    board_start();
    stage_init(&state);
    report("stack", run_for_stack());
    report("state", sizeof state);
    report("fault", stage_fault(&state));
    report("unsaved", (word)differs_after_saving());
    report("nothing", ticks_of(nothing, zeros, &unused));
    report("return", ticks_of_plain(board_return));
    report("hundred", ticks_of_plain(board_hundred));
    stage_init(&state);
    run_for_ticks();
    for (size_t k = 0; k < SAMPLES; ++k) {
        pattern one, two;
        one.value = y[k];
        two.value = again[k];
        if (one.bits != two.bits) {
            board_write("the second run differs from the first\n");
            board_exit(1);
        }
        report("y", one.bits);
        report("ticks", ticks[k]);
    }
    board_exit(0);
    return 0;
}
