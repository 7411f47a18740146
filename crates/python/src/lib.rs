//! The extension of the Python package `pontoon`: the engine in a Python process.
//!
//! | module | charter |
//! |---|---|
//! | `bridge` | a bridge that a Python program holds |
//! | `session` | studies that are solved without a file |
//! | `command` | commands of the program as functions, and the program itself |
//! | `folder` | tables of a folder of results |
//! | `table` | tables as Python takes them |
//! | `capsule` | a table handed over by Arrow's C interface; the only module with `unsafe` code |
//! | `waiting` | work on threads of its own, while Python hears of interrupts |
//! | `errors` | what is wrong, as exceptions |
//!
//! Knows Python. Does not know bridges, designs or columns: words are those of the study file, the bridge file and the registry.

mod bridge;
mod capsule;
mod command;
mod errors;
mod folder;
mod session;
mod table;
mod waiting;

/// What the package's Python modules call.
#[pyo3::pymodule]
mod _engine {
    #[pymodule_export]
    use super::bridge::{BridgeDocument, vehicle_json};
    #[pymodule_export]
    use super::command::{call, program};
    #[pymodule_export]
    use super::errors::refuse_word;
    #[pymodule_export]
    use super::folder::{read_table, table_names, table_of_rows};
    #[pymodule_export]
    use super::session::{FunctionStudy, Session};
    #[pymodule_export]
    use super::table::EngineTable;

    /// The version of the engine.
    #[pymodule_export]
    #[allow(non_upper_case_globals, reason = "the name that Python programs look for")]
    const __version__: &str = pontoon_results::VERSION;
}
