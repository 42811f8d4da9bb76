"""hyst observer: a spec read, an observer designed, tried, judged and written."""
