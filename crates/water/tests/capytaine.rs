//! netCDF files of Capytaine become the neutral form, and damaged ones are refused.
//!
//! Knows the formulas of `data/fixtures.py`. Does not know physics.

#![allow(clippy::unwrap_used)]

use pontoon_plan::input::{Refusal, RefusalKind};
use pontoon_plan::water_file::{ModuleLengths, full};
use pontoon_water::{Options, Reading, WaterDepth, WaterFacts, WaterFormat, read};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(data(name)).unwrap()
}

fn options() -> Options {
    Options {
        facts: WaterFacts {
            module_length_m: Some(ModuleLengths::Same(6.0)),
            ..WaterFacts::default()
        },
        ..Options::default()
    }
}

fn read_bytes(bytes: &[u8], options: &Options) -> Result<Reading, Refusal> {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("w.nc");
    std::fs::write(&file, bytes).unwrap();
    read(&file, options)
}

fn refused(bytes: &[u8]) -> Refusal {
    read_bytes(bytes, &options()).unwrap_err()
}

/// Bytes with a part replaced wherever it stands.
fn replaced(bytes: &[u8], part: &[u8], by: &[u8]) -> Vec<u8> {
    assert_eq!(part.len(), by.len());
    let (mut bytes, mut found) = (bytes.to_vec(), 0);
    for at in 0..bytes.len() - part.len() {
        if &bytes[at..at + part.len()] == part {
            bytes[at..at + part.len()].copy_from_slice(by);
            found += 1;
        }
    }
    assert!(found > 0, "nothing to replace");
    bytes
}

fn check_numbers(reading: &Reading) {
    let water = &reading.water;
    assert_eq!((water.modules, water.order()), (2, 6));
    assert_eq!(water.omega_rad_s, [0.0, 0.5, 1.5]);
    let expected = |constant: f64, factor: f64| -> Vec<f64> {
        let places = (0..6_u8).flat_map(|i| (0..6_u8).map(move |j| (f64::from(i), f64::from(j))));
        places
            .map(|(i, j)| constant + factor * (i + j) + if i == j { 0.0 } else { 0.25 })
            .collect()
    };
    for (i, omega) in [0.0, 0.5, 1.5].into_iter().enumerate() {
        assert_eq!(full(6, &water.added_mass[i]), expected(1000.0 + omega, 10.0));
        let damping = full(6, &water.radiation_damping[i]);
        assert_eq!(
            (damping[0], damping[7], damping[11]),
            (omega * 50.0, omega * 52.0, omega * 56.0)
        );
    }
    let infinite = water.infinite_added_mass.as_ref().unwrap();
    assert_eq!(full(6, infinite), expected(900.0, 10.0));
}

#[test]
fn both_kinds_of_netcdf_are_the_same_water() {
    let classic = read(&data("two_modules_classic.nc"), &options()).unwrap();
    let hdf5 = read(&data("two_modules.nc"), &options()).unwrap();
    assert_eq!(classic.format, WaterFormat::CapytaineClassic);
    assert_eq!(hdf5.format, WaterFormat::CapytaineHdf5);
    check_numbers(&classic);
    check_numbers(&hdf5);
    for reading in [&classic, &hdf5] {
        let water = &reading.water;
        assert_eq!(
            (water.density_kg_m3, water.gravity_m_s2, water.depth_m),
            (1000.0, 9.81, None)
        );
        assert_eq!(
            (water.hull.as_str(), water.source.program.as_str()),
            ("box 12 x 6 x 0.2 m", "Capytaine")
        );
        assert_eq!(water.source.version.as_deref(), Some("3.0.0"));
        assert_eq!(reading.notes, ["the frequencies were put in order"]);
    }
    let hash = blake3::hash(&bytes("two_modules.nc")).to_hex().to_string();
    assert_eq!(hdf5.water.source.blake3, Some(hash));
}

#[test]
fn how_far_the_matrices_were_from_symmetric_is_told() {
    let reading = read(&data("two_modules.nc"), &options()).unwrap();
    let last = reading.asymmetries[2];
    // half a unit between the heaves; the largest entry is that of the second one, as pitch and roll are over 6 m / sqrt(12)
    assert!((last.added_mass - 0.5 / 1061.5).abs() < 1e-12, "{last:?}");
    assert_eq!((last.omega_rad_s, last.radiation_damping), (1.5, 0.0));
    let largest = reading.water.source.asymmetry.unwrap();
    assert_eq!(
        (largest.added_mass, largest.radiation_damping),
        (reading.asymmetries[1].added_mass, 0.0)
    );
}

#[test]
fn compressed_files_and_water_with_a_bottom_are_read() {
    let shallow = read(&data("two_modules_4_m.nc"), &options()).unwrap();
    check_numbers(&shallow);
    assert_eq!(shallow.water.depth_m, Some(4.0));
    let mut told = options();
    told.facts.draught_m = Some(5.0);
    let e = read(&data("two_modules_4_m.nc"), &told).unwrap_err();
    assert_eq!((e.path.as_str(), e.kind), ("depth_m", RefusalKind::Conflict), "{e}");
}

#[test]
fn what_the_reader_was_told_has_to_agree() {
    let file = data("two_modules.nc");
    let refused = |change: fn(&mut Options)| {
        let mut options = options();
        change(&mut options);
        let e = read(&file, &options).unwrap_err();
        (e.path.clone(), e.kind, e.to_string())
    };
    let (path, kind, text) = refused(|o| o.modules = Some(15));
    assert_eq!((path.as_str(), kind), ("modules", RefusalKind::Conflict));
    assert!(text.contains("found 2, allowed: 15"), "{text}");
    assert_eq!(refused(|o| o.facts.depth = Some(WaterDepth::Metres(4.0))).0, "depth_m");
    assert_eq!(refused(|o| o.facts.density_kg_m3 = Some(1025.0)).0, "density_kg_m3");
    let (path, kind, _) = refused(|o| o.facts.module_length_m = None);
    assert_eq!((path.as_str(), kind), ("module_length_m", RefusalKind::Missing));
    assert_eq!(
        refused(|o| o.facts.module_length_m = Some(ModuleLengths::Each(vec![6.0; 3]))).0,
        "module_length_m"
    );
}

#[test]
fn wrong_names_numbers_and_frequencies_are_refused_at_their_variable() {
    let classic = bytes("two_modules_classic.nc");
    let e = refused(&replaced(&classic, b"m02__pitch", b"m02__pitsh"));
    assert_eq!(
        (e.path.as_str(), e.kind),
        ("influenced_dof[5]", RefusalKind::UnknownWord),
        "{e}"
    );
    assert_eq!(e.nearest.as_deref(), Some("m02__pitch"), "{e}");
    let e = refused(&replaced(&classic, b"m02__pitch", b"m01__pitch"));
    assert_eq!(
        (e.path.as_str(), e.kind),
        ("influenced_dof[5]", RefusalKind::Repeated),
        "{e}"
    );
    let e = refused(&replaced(&classic, &1001.5_f64.to_be_bytes(), &f64::NAN.to_be_bytes()));
    assert_eq!(e.path, "added_mass", "{e}");
    assert!(
        e.to_string()
            .contains("found NaN at 1.5 rad/s, m01__heave by m01__heave"),
        "{e}"
    );
    let e = refused(&replaced(
        &classic,
        &75.0_f64.to_be_bytes(),
        &f64::INFINITY.to_be_bytes(),
    ));
    assert_eq!(e.path, "radiation_damping", "{e}");
    // 1.5 stands in the file as a frequency alone
    for (omega, path) in [
        (-1.5, "omega[0]"),
        (f64::NAN, "omega[0]"),
        (0.5, "omega_rad_s"),
        (f64::INFINITY, "omega[1]"),
    ] {
        let e = refused(&replaced(&classic, &1.5_f64.to_be_bytes(), &omega.to_be_bytes()));
        assert_eq!(e.path, path, "{e}");
    }
    for (variable, by) in [
        (b"added_mass", b"added_m_ss"),
        (b"radiating_".as_slice().try_into().unwrap(), b"radiatong_"),
    ] {
        let e = refused(&replaced(&classic, variable, by));
        assert!(!e.path.is_empty(), "{e}");
    }
}

#[test]
fn cut_files_are_refused() {
    for name in ["two_modules_classic.nc", "two_modules.nc", "two_modules_4_m.nc"] {
        let whole = bytes(name);
        let step = whole.len() / 200 + 1;
        for length in (0..whole.len() - 8).step_by(step) {
            let read = read_bytes(&whole[..length], &options());
            assert!(read.is_err(), "{name} cut to {length} of {}", whole.len());
        }
    }
}

#[test]
fn no_damaged_byte_brings_the_program_down() {
    for name in ["two_modules_classic.nc", "two_modules.nc", "two_modules_4_m.nc"] {
        let whole = bytes(name);
        for at in (0..whole.len()).step_by(whole.len() / 500 + 1) {
            for flip in [0xff, 0x01, 0x80] {
                let mut damaged = whole.clone();
                damaged[at] ^= flip;
                // read or refused: both are answers
                let _ = read_bytes(&damaged, &options());
            }
        }
    }
}
