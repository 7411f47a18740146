//! The program from outside: words, exit statuses, files.

mod bounds;
mod calibrate;
mod calibrate_input;
mod compare;
mod compare_formats;
mod compare_histories;
mod compare_input;
mod compare_kinds;
mod contradictions;
mod damaged;
mod designs;
mod export;
mod export_input;
mod export_stage;
mod export_stresses;
mod figures;
mod joints;
mod old_results;
mod operator;
mod recorded;
mod refusals;
mod report;
mod results;
mod shells;
mod shown_places;
mod terminal;
