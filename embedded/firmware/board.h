/* What the measuring program asks of the machine it runs on. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

void board_start(void);
void board_write(const char *text);
void board_exit(int failed);

/* Runs through 24 bits, by a fixed number of ticks for each instruction; see embedded/target.py. */
uint32_t board_ticks(void);

/* The lowest address of the stack; 0 where it is not watched. */
uintptr_t board_stack_limit(void);

/* 100 instructions that do nothing, and a return: what is counted for it is checked. */
void board_hundred(void);
void board_return(void);

#endif
