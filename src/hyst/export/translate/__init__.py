"""The exported C as a typed program, for targets whose language is not C.

A kernel is written once, in C99. Other languages get it by translation of what the export
contains, never by a second hand: ``program_of`` gives the functions, structures and tables that an
entry point reaches, every expression with its type, and refuses what it does not know.
"""
