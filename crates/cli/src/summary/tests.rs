//! Tables of summaries with awkward axes, as they are read.

use super::text;
use crate::terminal::TextStyle;
use pontoon_plan::input::Cell;
use serde_json::{Value, json};

const COLUMNS: &str = "connection gap_tension_m gap_compression_m load_n speed_m_s peak_deflection_m peak_uplift_m peak_compression_n peak_tension_n";

/// Of a file or pipe.
const PLAIN: TextStyle = TextStyle {
    colour: false,
    width: None,
};

fn columns(names: &str) -> Vec<String> {
    names.split_whitespace().map(str::to_owned).collect()
}

fn narrow(width: usize) -> TextStyle {
    TextStyle {
        width: Some(width),
        ..PLAIN
    }
}

/// A crossing: its axes and largest deflection `[m]`; the other peaks follow from it.
fn row(axes: Value, deflection_m: Option<f64>) -> Vec<Value> {
    let mut row = axes.as_array().unwrap().clone();
    row.extend([1.0, 0.1, 5e6, 1e6].map(|factor| deflection_m.map_or(Value::Null, |d| (d * factor).into())));
    row
}

fn text_of(names: &str, rows: &[Vec<Value>], text_style: TextStyle) -> String {
    text(
        &columns(names),
        || rows.iter().map(|row| row.iter().map(Cell::of).collect()),
        text_style,
    )
}

fn written(names: &str, rows: &[Vec<Value>], text_style: TextStyle) -> String {
    let text = text_of(names, rows, text_style);
    if let Some(width) = text_style.width {
        let longest = text.lines().map(|line| line.chars().count()).max().unwrap();
        // the name of a peak and its value are not broken
        assert!(longest <= width.max(31), "{longest} characters:\n{text}");
    }
    text
}

fn crossings() -> Vec<Vec<Value>> {
    let mut rows = Vec::new();
    for (connection, tension, compression, first) in [
        ("linear", json!(null), json!(null), 0.15),
        ("nonlinear", json!(0.028), json!(0.0055), 0.2),
        ("nonlinear", json!(0), json!(0.0055), 0.18),
    ] {
        for (i, speed) in [3.0, 7.5, 15.0].into_iter().enumerate() {
            let axes = json!([connection, tension, compression, 230300.0, speed]);
            rows.push(row(axes, Some(first + 0.01 * i as f64)));
        }
    }
    rows
}

#[test]
fn speeds_are_columns_and_what_is_constant_is_told_once() {
    let expected = "\
peak deflection [m] against speed [m/s]
throughout: compression gap 0.0055 m, load 230300 N

            tension
                gap
connection      [m]       3     7.5      15
linear        -      0.1500  0.1600  0.1700
nonlinear     0.028  0.2000  0.2100  0.2200*
nonlinear     0      0.1800  0.1900  0.2000

largest deflection    0.2200 m  speed 15 m/s, connection nonlinear, tension gap 0.028 m
largest uplift        0.0220 m  speed 15 m/s, connection nonlinear, tension gap 0.028 m
largest compression  1100000 N  speed 15 m/s, connection nonlinear, tension gap 0.028 m
largest tension       220000 N  speed 15 m/s, connection nonlinear, tension gap 0.028 m
";
    assert_eq!(written(COLUMNS, &crossings(), PLAIN), expected);
}

#[test]
fn a_largest_peak_of_zero_has_no_place() {
    let mut rows = crossings();
    for row in &mut rows {
        *row.last_mut().unwrap() = json!(0.0);
    }
    let text = written(COLUMNS, &rows, PLAIN);
    let tension = text.lines().last().unwrap();
    assert_eq!(tension, "largest tension            0 N");
}

#[test]
fn the_table_goes_on_below_where_a_terminal_is_narrow() {
    let text = written(COLUMNS, &crossings(), narrow(40));
    let table = "\
connection      [m]       3     7.5
linear        -      0.1500  0.1600
nonlinear     0.028  0.2000  0.2100
nonlinear     0      0.1800  0.1900

            tension
                gap
connection      [m]      15
linear        -      0.1700
nonlinear     0.028  0.2200*
nonlinear     0      0.2000
";
    assert!(text.contains(table), "{text}");
}

#[test]
fn numbers_stand_for_names_that_leave_no_room() {
    let text = written(COLUMNS, &crossings(), narrow(26));
    let table = "\
#1 connection linear
#2 connection nonlinear,
   tension gap 0.028 m
#3 connection nonlinear,
   tension gap 0 m

        3     7.5      15
#1 0.1500  0.1600  0.1700
#2 0.2000  0.2100  0.2200*
#3 0.1800  0.1900  0.2000
";
    assert!(text.contains(table), "{text}");
}

#[test]
fn of_one_speed_all_peaks_are_listed() {
    let rows: Vec<Vec<Value>> = crossings().into_iter().filter(|row| row[4] == 15.0).collect();
    let expected = "\
peaks
throughout: compression gap 0.0055 m, load 230300 N, speed 15 m/s

            tension
                gap  deflection  uplift  compression  tension
connection      [m]         [m]     [m]          [N]      [N]
linear        -          0.1700  0.0170       850000   170000
nonlinear     0.028      0.2200* 0.0220*     1100000*  220000*
nonlinear     0          0.2000  0.0200      1000000   200000
";
    let text = written(COLUMNS, &rows, PLAIN);
    assert!(text.starts_with(expected), "{text}");
}

#[test]
fn a_single_job_is_a_line_without_a_star() {
    let text = written(COLUMNS, &crossings()[..1], PLAIN);
    assert!(
        text.contains("throughout: connection linear, load 230300 N, speed 3 m/s\n"),
        "{text}"
    );
    assert!(text.ends_with("0.1500  0.0150       750000   150000\n"), "{text}");
}

#[test]
fn failed_jobs_say_so_and_jobs_that_are_not_there_leave_a_blank() {
    let mut rows = crossings();
    rows[1] = row(Value::from(rows[1][..5].to_vec()), None);
    rows.remove(4);
    let text = written(COLUMNS, &rows, PLAIN);
    assert!(text.contains("linear        -      0.1500  failed  0.1700\n"), "{text}");
    assert!(
        text.contains("nonlinear     0.028  0.2000          0.2200*\n"),
        "{text}"
    );
}

#[test]
fn where_all_jobs_failed_nothing_is_largest() {
    let rows: Vec<Vec<Value>> = crossings()
        .iter()
        .map(|of| row(Value::from(of[..5].to_vec()), None))
        .collect();
    let text = written(COLUMNS, &rows, PLAIN);
    assert!(
        text.contains("all failed") && !text.contains("largest") && !text.contains('*'),
        "{text}"
    );
    let text = written(COLUMNS, &rows[..1], narrow(60));
    assert!(text.contains("failed") && !text.contains("largest"), "{text}");
}

#[test]
fn words_lists_and_paths_are_axes_like_others() {
    let names = "bridge.module.depth_m vehicle.track_y_m analysis.model speed_m_s peak_deflection_m";
    let mut rows = Vec::new();
    for (depth, track, model) in [
        (1.07, json!([-1.4, 1.4]), "full"),
        (0.9, json!([1, 3]), "super-element"),
    ] {
        for speed in [5, 10] {
            rows.push(vec![
                json!(depth),
                track.clone(),
                json!(model),
                json!(speed),
                json!(0.1 * depth),
            ]);
        }
    }
    let text = written(names, &rows, PLAIN);
    let expected = "\
peak deflection [m] against speed [m/s]

       track
depth  y
  [m]  [m]         model               5      10
 1.07  [-1.4,1.4]  full           0.1070* 0.1070
 0.9   [1,3]       super-element  0.0900  0.0900

largest deflection  0.1070 m  speed 5 m/s, depth 1.07 m, track y [-1.4,1.4] m, model full
";
    assert_eq!(text, expected);
}

#[test]
fn two_hundred_combinations_are_cut_and_the_largest_is_still_told() {
    let mut rows = Vec::new();
    for i in 0..200 {
        for speed in [5, 10] {
            let axes = json!(["nonlinear", 0.001 * f64::from(i), 0.0055, 230300, speed]);
            rows.push(row(axes, Some(0.1 + 0.001 * f64::from(i) + 0.01 * f64::from(speed))));
        }
    }
    let text = written(COLUMNS, &rows, narrow(80));
    assert!(
        text.contains("\nand 160 more combinations: see summary.csv\n"),
        "{text}"
    );
    assert!(text.lines().count() < 60, "{text}");
    assert!(
        text.contains("largest deflection    0.3990 m  speed 10 m/s, tension gap 0.199 m\n"),
        "{text}"
    );
}

#[test]
fn many_speeds_make_pieces_of_few_rows() {
    let mut rows = Vec::new();
    for i in 0..30 {
        for speed in 1..=50 {
            rows.push(row(
                json!(["nonlinear", 0.001 * f64::from(i), 0.0055, 230300, speed]),
                Some(0.1),
            ));
        }
    }
    let text = written(COLUMNS, &rows, narrow(80));
    assert!(text.lines().count() < 100, "{}\n{text}", text.lines().count());
    assert!(text.contains("more combinations: see summary.csv"), "{text}");
}

#[test]
fn points_drawn_at_random_are_listed_by_their_deflection() {
    let point = |i: i32| {
        let axes = json!([
            "nonlinear",
            0.0001 * f64::from(i),
            0.0055,
            230300,
            5.0 + 0.01 * f64::from(i)
        ]);
        row(axes, Some(0.1 + 0.001 * f64::from((i * 37) % 200)))
    };
    let rows: Vec<Vec<Value>> = (0..200).map(point).collect();
    let text = written(COLUMNS, &rows, narrow(80));
    let listed: Vec<&str> = text
        .lines()
        .skip_while(|line| !line.contains("[m/s]"))
        .skip(1)
        .take(40)
        .collect();
    let deflection = |line: &&str| -> f64 {
        line.split_whitespace()
            .nth(2)
            .unwrap()
            .trim_end_matches('*')
            .parse()
            .unwrap()
    };
    let listed: Vec<f64> = listed.iter().map(deflection).collect();
    assert_eq!((listed.len(), listed[0]), (40, 0.299), "{text}");
    assert!(listed.is_sorted_by(|a, b| a >= b), "{text}");
    assert!(
        text.contains("and 160 more jobs with less deflection: see summary.csv"),
        "{text}"
    );
}

#[test]
fn static_cases_go_along_the_places_of_the_load() {
    let names = "connection gap_tension_m gap_compression_m load_position load_x_m load_n peak_deflection_m";
    let mut rows = Vec::new();
    for connection in ["linear", "nonlinear"] {
        let gap = if connection == "linear" {
            Value::Null
        } else {
            json!(0.01)
        };
        for place in 1..=3 {
            let x = 6.7 * f64::from(place - 1);
            rows.push(vec![
                json!(connection),
                gap.clone(),
                gap.clone(),
                json!(place),
                json!(x),
                json!(1e5),
                json!(0.1 * f64::from(place)),
            ]);
        }
    }
    let expected = "\
peak deflection [m] against load position
throughout: tension gap 0.01 m, compression gap 0.01 m, load 100000 N

connection       1       2       3
linear      0.1000  0.2000  0.3000*
nonlinear   0.1000  0.2000  0.3000

largest deflection  0.3000 m  load position 3, connection linear
";
    assert_eq!(written(names, &rows, PLAIN), expected);
    // places that are no positions
    rows.iter_mut().for_each(|row| row[3] = Value::Null);
    let text = written(names, &rows, PLAIN);
    assert!(
        text.contains("against load place [m]") && text.contains("connection       0     6.7    13.4\n"),
        "{text}"
    );
}

#[test]
fn frequencies_stand_beside_the_names_of_their_shapes() {
    let names = "bridge.modules analysis.model number frequency_hz shape";
    let mut rows = Vec::new();
    for modules in [1, 15] {
        for (number, (hz, shape)) in [(0.35, "heave"), (0.36, "local"), (0.37, "local")]
            .into_iter()
            .enumerate()
        {
            rows.push(vec![
                json!(modules),
                json!("full"),
                json!(number + 1),
                json!(hz * f64::from(modules)),
                json!(shape),
            ]);
        }
    }
    rows.pop();
    let expected = "\
natural frequencies [Hz]
throughout: model full

modules        1       15
heave    0.35000  5.25000
local    0.36000  5.40000
local    0.37000
";
    assert_eq!(written(names, &rows, PLAIN), expected);
    let text = written(
        "number frequency_hz shape",
        &[vec![json!(1), json!(0.5), json!("heave")]],
        PLAIN,
    );
    assert_eq!(text, "natural frequencies [Hz]\n\nheave  0.50000\n");
    assert_eq!(
        written("number frequency_hz shape", &[], PLAIN),
        "natural frequencies [Hz]\n\nnone: all jobs failed\n"
    );
}

#[test]
fn colours_are_where_they_are_shown_and_move_nothing() {
    let text_style = TextStyle {
        colour: true,
        width: Some(118),
    };
    let [coloured, plain] = [text_style, PLAIN].map(|text_style| text_of(COLUMNS, &crossings(), text_style));
    assert!(coloured.contains("\u{1b}["), "{coloured}");
    let mut bare = String::new();
    let mut rest = coloured.as_str();
    while let Some((before, after)) = rest.split_once('\u{1b}') {
        bare += before;
        rest = after.split_once('m').unwrap().1;
    }
    assert_eq!(bare + rest, plain);
}
