//! What the paper prints.

mod printed;
