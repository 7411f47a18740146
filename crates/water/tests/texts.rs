//! Texts of WAMIT and NEMOH become the neutral form, and damaged ones are refused with their line.
//!
//! Knows the forms of these texts. Does not know physics: the numbers are none.

#![allow(clippy::unwrap_used)]

use pontoon_plan::input::{Refusal, RefusalKind};
use pontoon_plan::water_file::{ModuleLengths, full};
use pontoon_water::{BemModes, Options, Reading, WaterDepth, WaterFacts, WaterFormat, read};
use std::f64::consts::TAU;
use std::fmt::Write;
use tempfile::TempDir;

fn options() -> Options {
    Options {
        facts: WaterFacts {
            module_length_m: Some(ModuleLengths::Same(6.0)),
            depth: Some(WaterDepth::Deep),
            density_kg_m3: Some(1000.0),
            gravity_m_s2: Some(9.81),
            ..WaterFacts::default()
        },
        ..Options::default()
    }
}

/// Reads the first of some files that stand beside each other.
fn read_files(files: &[(&str, &str)], options: &Options) -> Result<Reading, Refusal> {
    let folder = TempDir::new().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    read(&folder.path().join(files[0].0), options)
}

fn refused(files: &[(&str, &str)], options: &Options) -> Refusal {
    read_files(files, options).unwrap_err()
}

/// Coefficients of `count` modes, one more than their numbers together; as the code leaves zeros out, those of far modes.
fn wamit(count: usize) -> String {
    let mut text = " WAMIT Numeric Output -- Filename  two.1\n".to_owned();
    for period in ["-1.000000E+00", "0.000000E+00", "4.000000E+00", "2.000000E+00"] {
        for i in 1..=count {
            for j in (1..=count).filter(|j| i.abs_diff(*j) < 4) {
                write!(text, " {period} {i:5} {j:5} {:13.6e}", (i + j + 1) as f64).unwrap();
                if !period.contains("-1") && !period.contains("0.0") {
                    write!(text, " {:13.6e}", (i + j) as f64 / 10.0).unwrap();
                }
                text.push('\n');
            }
        }
    }
    text
}

fn hydrostatics(areas: &[(usize, f64)]) -> String {
    let mut text = " WAMIT -- Force Output File -- two.hst\n".to_owned();
    for (mode, area) in areas {
        writeln!(text, "{mode:6}{mode:6} {area:13.6e}").unwrap();
    }
    text
}

#[test]
fn wamit_gives_the_modules_of_its_bodies() {
    let text = wamit(12);
    let hst = hydrostatics(&[(3, 33.0), (9, 33.0)]);
    let reading = read_files(&[("two.1", &text), ("two.hst", &hst)], &options()).unwrap();
    let water = &reading.water;
    assert_eq!((reading.format, water.modules), (WaterFormat::Wamit, 2));
    assert_eq!(water.omega_rad_s, [0.0, TAU / 4.0, TAU / 2.0]);
    // heave 3, pitch 5, roll 4; of the other body 9, 11, 10
    let mass = full(6, &water.added_mass[1]);
    assert_eq!((mass[0], mass[1], mass[2], mass[3]), (7000.0, 9000.0, 8000.0, 0.0));
    assert_eq!(mass[4 * 6 + 4], 23000.0);
    let damping = full(6, &water.radiation_damping[2]);
    assert!((damping[0] - 0.6 * 1000.0 * TAU / 2.0).abs() < 1e-9);
    assert!(water.radiation_damping[0].iter().all(|damping| *damping == 0.0));
    assert_eq!(water.infinite_added_mass.as_ref().unwrap()[0], 7000.0);
    assert_eq!(water.waterline_breadth_m, Some(5.5));
    assert!(
        reading.notes.iter().any(|note| note.contains("66.0000 m2")),
        "{:?}",
        reading.notes
    );
    assert_eq!(water.name, "two");
}

#[test]
fn wamit_coefficients_have_the_length_scale_they_were_made_with() {
    let options = Options {
        length_scale_m: Some(2.0),
        ..options()
    };
    let water = read_files(&[("two.1", &wamit(12))], &options).unwrap().water;
    let mass = full(6, &water.added_mass[1]);
    // forces by heave L^3, moments by heave L^4, moments by rotation L^5
    assert_eq!(
        (mass[0], mass[1], mass[7]),
        (7000.0 * 8.0, 9000.0 * 16.0, 11000.0 * 32.0)
    );
    let listed = Options {
        modes: BemModes::Listed(vec![3, 5, 12]),
        ..options
    };
    let e = refused(&[("two.1", &wamit(12))], &listed);
    assert_eq!(
        (e.path.as_str(), e.kind),
        ("length_scale_m", RefusalKind::Conflict),
        "{e}"
    );
}

#[test]
fn wamit_modes_may_be_listed() {
    let ten = wamit(10);
    let e = refused(&[("ten.1", &ten)], &options());
    assert_eq!((e.path.as_str(), e.kind), ("modes", RefusalKind::Conflict), "{e}");
    let listed = |modes: &[usize]| Options {
        modes: BemModes::Listed(modes.to_vec()),
        ..options()
    };
    let reading = read_files(&[("ten.1", &ten)], &listed(&[3, 5, 4])).unwrap();
    assert_eq!(
        (reading.water.modules, full(3, &reading.water.added_mass[0])[4]),
        (1, 11000.0)
    );
    assert_eq!(reading.notes[0], "7 of 10 modes are none of the modules' freedoms");
    assert_eq!(refused(&[("ten.1", &ten)], &listed(&[3, 5, 11])).path, "modes[2]");
}

#[test]
fn damaged_texts_of_wamit_are_refused_with_their_line() {
    let text = wamit(6);
    let lines: Vec<&str> = text.lines().collect();
    let with = |line: usize, by: &str| {
        let mut lines = lines.clone();
        lines[line - 1] = by;
        lines.join("\n") + "\n"
    };
    let last = lines.len();
    for (text, path) in [
        (with(5, " -1.0 1 4 NaN"), "line 5"),
        (with(5, " -1.0 1 x 1.0"), "line 5"),
        (with(5, " -1.0 1 0 1.0"), "line 5"),
        (with(5, " -1.0 1"), "line 5"),
        (with(last, " 2.0 6 6 1.0"), &format!("line {last}")),
        (with(last, lines[last - 2]), &format!("line {last}")),
        (text[..text.len() - 4].to_owned(), &format!("line {last}")),
    ] {
        let e = refused(&[("w.1", &text)], &options());
        assert_eq!(e.path, path, "{e}");
    }
    // a whole line less
    let short = lines[..last - 1].join("\n") + "\n";
    let e = refused(&[("w.1", &short)], &options());
    assert!(
        e.to_string().contains("29 coefficients at the period 2, allowed: 30"),
        "{e}"
    );
    // roll was held
    let held: String = lines
        .iter()
        .filter(|line| !line.contains("     4     4 "))
        .map(|line| format!("{line}\n"))
        .collect();
    let e = refused(&[("w.1", &held)], &options());
    assert!(
        e.to_string()
            .contains("no coefficient of mode 4 with itself at the period -1"),
        "{e}"
    );
    let e = refused(&[("w.1", &text), ("w.hst", "     1     1   1.0\n")], &options());
    assert!(e.file.ends_with("w.hst"), "{e}");
    let e = refused(&[("w.hst", &hydrostatics(&[(3, 1.0)]))], &options());
    assert!(e.to_string().contains("hydrostatic file"), "{e}");
}

/// Zones of `count` motions at two frequencies, each number on a line of its own where `wrapped`.
fn tecplot(count: usize, label: &str, frequencies: [f64; 2], wrapped: bool) -> String {
    let mut text = format!("VARIABLES=\"{label}\"\n");
    let body = |mode: usize| (mode / 6 + 1, mode % 6 + 1);
    for force in 0..count {
        let (body, freedom) = body(force);
        writeln!(text, "\"A{body:4}{freedom:4}\" \"B{body:4}{freedom:4}\"").unwrap();
    }
    for motion in 0..count {
        let (body, freedom) = body(motion);
        writeln!(
            text,
            "Zone t=\"Motion of body {body:4} in DoF{freedom:4}\",I=     2,F=POINT"
        )
        .unwrap();
        for frequency in frequencies {
            write!(text, " {frequency:14.7E}").unwrap();
            for force in 0..count {
                let (mass, damping) = ((motion + force) as f64, (motion * force) as f64);
                let gap = if wrapped { "\n" } else { " " };
                write!(text, "{gap}{mass:14.7E} {damping:14.7E}").unwrap();
            }
            text.push('\n');
        }
    }
    text
}

#[test]
fn nemoh_zones_are_read_however_their_lines_are_wrapped() {
    for (label, frequencies) in [
        ("w (rad/s)", [1.0, 2.0]),
        ("f (Hz)", [1.0 / TAU, 2.0 / TAU]),
        ("T (s)", [TAU, TAU / 2.0]),
    ] {
        for wrapped in [false, true] {
            let text = tecplot(12, label, frequencies, wrapped);
            let reading = read_files(&[("RadiationCoefficients.tec", &text)], &options()).unwrap();
            let water = &reading.water;
            assert_eq!((reading.format, water.modules), (WaterFormat::NemohTecplot, 2));
            assert!((water.omega_rad_s[0] - 1.0).abs() < 1e-6 && (water.omega_rad_s[1] - 2.0).abs() < 1e-6);
            let (mass, damping) = (full(6, &water.added_mass[0]), full(6, &water.radiation_damping[1]));
            // places 2, 4, 3 of the first body, 8, 10, 9 of the other
            assert_eq!((mass[0], mass[1], mass[3 * 6 + 4]), (4.0, 6.0, 18.0));
            assert_eq!((damping[0], damping[2], damping[35]), (4.0, 6.0, 81.0));
        }
    }
}

#[test]
fn damaged_zones_of_nemoh_are_refused() {
    let text = tecplot(6, "w (rad/s)", [1.0, 2.0], false);
    let file = |text: &str| refused(&[("r.tec", text)], &options());
    assert_eq!(file(&text[..text.len() - 30]).path, "line 25");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(file(&(lines[..24].join("\n") + "\n")).path, "line 24");
    assert!(
        file(&(lines[..22].join("\n") + "\n"))
            .to_string()
            .contains("6 forces and 5 motions")
    );
    assert_eq!(
        file(&text.replacen("2.0000000E0 ", "NaN ", 1)).kind,
        RefusalKind::NotAllowed
    );
    assert_eq!(file(&text.replace("w (rad/s)", "k (1/m)")).path, "line 1");
}

/// A table at two frequencies, six numbers a line.
fn table(order: usize, factor: f64) -> String {
    let mut text = "Nb de frequency :    2\n".to_owned();
    for omega in [0.5, 1.5] {
        writeln!(text, "{omega:7.4}").unwrap();
        for i in 0..order {
            let row: Vec<String> = (0..order)
                .map(|j| format!("{:13.6E}", factor * (i + j) as f64))
                .collect();
            for part in row.chunks(6) {
                writeln!(text, " {}", part.join(" ")).unwrap();
            }
        }
    }
    text
}

#[test]
fn nemoh_tables_belong_together_whichever_is_named() {
    let (mass, damping) = (table(12, 10.0), table(12, 1.0));
    let one = read_files(&[("CM.dat", &mass), ("CA.dat", &damping)], &options()).unwrap();
    let other = read_files(&[("CA.dat", &damping), ("CM.dat", &mass)], &options()).unwrap();
    assert_eq!(one.format, WaterFormat::NemohTables);
    assert_eq!(one.water.source.blake3, other.water.source.blake3);
    for water in [&one.water, &other.water] {
        assert_eq!(water.omega_rad_s, [0.5, 1.5]);
        assert_eq!((water.added_mass[0][0], water.radiation_damping[1][0]), (40.0, 4.0));
    }
}

#[test]
fn damaged_tables_of_nemoh_are_refused() {
    let (mass, damping) = (table(6, 10.0), table(6, 1.0));
    let e = refused(&[("CM.dat", &mass)], &options());
    assert!(e.file.ends_with("CA.dat"), "{e}");
    let e = refused(&[("other.dat", &mass)], &options());
    assert!(e.to_string().contains("nothing else tells them apart"), "{e}");
    let cut: String = mass.lines().take(12).map(|line| format!("{line}\n")).collect();
    assert_eq!(
        refused(&[("CM.dat", &cut), ("CA.dat", &damping)], &options()).path,
        "line 1"
    );
    let moved = damping.replace(" 1.5", " 1.7");
    let e = refused(&[("CM.dat", &mass), ("CA.dat", &moved)], &options());
    assert!(e.file.ends_with("CA.dat") && e.path == "line 9", "{e}");
    let small = refused(&[("CM.dat", &mass), ("CA.dat", &table(3, 1.0))], &options());
    assert!(small.to_string().contains("a matrix of 9 entries"), "{small}");
}

#[test]
fn what_is_of_no_known_form_is_refused() {
    for (text, words) in [
        ("", "an empty file"),
        (" \n", "an empty file"),
        ("hello\n", "no coefficients of a known form"),
        ("1 2 3 4 5 6 7\n", "no coefficients of a known form"),
        ("CDF", "no coefficients of a known form"),
        ("\u{0}\u{1}", "no coefficients of a known form"),
    ] {
        let e = refused(&[("w.x", text)], &options());
        assert!(e.to_string().contains(words), "{text:?}: {e}");
    }
    let e = read(std::path::Path::new("/no/such/file.nc"), &options()).unwrap_err();
    assert!(e.to_string().contains("no readable file"), "{e}");
}
