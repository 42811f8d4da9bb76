"""The answer of an observer: is the loop that runs safe, what does it buy, what is it."""
