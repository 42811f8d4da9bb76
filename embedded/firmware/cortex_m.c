/* Start of a Cortex-M under QEMU: floating-point unit, SysTick, output by semihosting. No library. */
#include "board.h"

#include <stddef.h>

#define CPACR (*(volatile uint32_t *)0xE000ED88u)
#define SYSTICK_CONTROL (*(volatile uint32_t *)0xE000E010u)
#define SYSTICK_RELOAD (*(volatile uint32_t *)0xE000E014u)
#define SYSTICK_NOW (*(volatile uint32_t *)0xE000E018u)

enum { SEMIHOSTING_WRITE0 = 0x04, SEMIHOSTING_EXIT_EXTENDED = 0x20 };

extern uint32_t stack_limit[];
extern uint32_t stack_top[];
int main(void);
void reset(void);
void fault(void);

static int semihosting(int operation, const void *argument)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void board_write(const char *text)
{
    (void)semihosting(SEMIHOSTING_WRITE0, text);
}

void board_exit(int failed)
{
    const uint32_t reason[2] = {0x20026u /* the application ends */, (uint32_t)failed};
    (void)semihosting(SEMIHOSTING_EXIT_EXTENDED, reason);
    for (;;) {
    }
}

void board_start(void)
{
    SYSTICK_RELOAD = 0x00FFFFFFu;
    SYSTICK_NOW = 0u;
    SYSTICK_CONTROL = 5u; /* on, from the processor's clock, without an interrupt */
}

uint32_t board_ticks(void)
{
    return 0x00FFFFFFu - SYSTICK_NOW;
}

uintptr_t board_stack_limit(void)
{
    return (uintptr_t)stack_limit;
}

__attribute__((naked, noinline)) void board_return(void)
{
    __asm__ volatile("bx lr");
}

__attribute__((naked, noinline)) void board_hundred(void)
{
    __asm__ volatile(".rept 100\n nop\n .endr\n bx lr");
}

void fault(void)
{
    board_write("the processor has stopped with a fault\n");
    board_exit(1);
}

__attribute__((naked)) void reset(void)
{
    /* Access to the floating-point unit before any function that might use it. */
    __asm__ volatile("ldr r0, =0xE000ED88\n"
                     "ldr r1, [r0]\n"
                     "orr r1, r1, #0x00F00000\n"
                     "str r1, [r0]\n"
                     "dsb\n isb\n"
                     "bl main\n"
                     "b .\n");
}

/* What a compiler may call by itself in freestanding code. */
void *memcpy(void *restrict to, const void *restrict from, size_t count);
void *memset(void *to, int value, size_t count);

void *memcpy(void *restrict to, const void *restrict from, size_t count)
{
    unsigned char *place = to;
    const unsigned char *source = from;
    while (count > 0u) {
        *place++ = *source++;
        --count;
    }
    return to;
}

void *memset(void *to, int value, size_t count)
{
    unsigned char *place = to;
    while (count > 0u) {
        *place++ = (unsigned char)value;
        --count;
    }
    return to;
}

typedef void (*handler)(void);
__attribute__((section(".vectors"), used)) static const handler vectors[16] = {
    (handler)(uintptr_t)stack_top, reset, fault, fault, fault, fault, fault, fault,
    fault, fault, fault, fault, fault, fault, fault, fault};
