//! Tests of journals as a whole.
