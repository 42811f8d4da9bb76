"""What tests of several folders share: reference implementations, examples, random operators."""
