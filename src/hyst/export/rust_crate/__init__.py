"""Export as a Rust crate without the standard library: the exported C, translated."""
