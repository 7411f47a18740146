//! The one font of figures, and an SVG's pixels drawn with it.
//!
//! Knows how wide words are. Does not know figures. No font of the machine is looked for: the same input gives the same
//! bytes everywhere. `font/README.md` says where the font is from.

use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, Unit};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};
use std::sync::Arc;
use thiserror::Error;

/// Families that an SVG asks for: the embedded one, then those whose letters are as wide.
pub(super) const FAMILY: &str = "Arimo, Arial, 'Liberation Sans', Helvetica, sans-serif";

/// Dots in an inch of the pixels.
pub(super) const DPI: f32 = 300.0;

/// Letters for pixels and widths.
const PIXELS: &[u8] = include_bytes!("font/Arimo-Regular.subset.ttf");

/// Letters for whoever opens an SVG.
const EMBEDDED: &[u8] = include_bytes!("font/Arimo-Regular.subset.woff2");

/// An SVG that became no pixels.
#[derive(Debug, Error)]
pub enum PixelsError {
    /// It cannot be read.
    #[error("an SVG that cannot be drawn: {0}")]
    Svg(#[from] resvg::usvg::Error),
    /// It cannot be written.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// It has no extent.
    #[error("a figure of no size")]
    NoSize,
    /// Its pixels cannot be written.
    #[error(transparent)]
    Png(#[from] png::EncodingError),
}

/// The font, read.
pub(super) struct Letters {
    options: Options<'static>,
    face: String,
}

impl Letters {
    /// Reads the font.
    pub(super) fn new() -> Self {
        let mut fonts = Database::new();
        fonts.load_font_data(PIXELS.to_vec());
        let options = Options {
            dpi: DPI,
            font_family: "Arimo".to_owned(),
            fontdb: Arc::new(fonts),
            ..Options::default()
        };
        let data = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, EMBEDDED);
        Self {
            options,
            face: format!("@font-face{{font-family:Arimo;src:url(data:font/woff2;base64,{data})}}"),
        }
    }

    /// The font as an SVG embeds it.
    pub(super) fn face(&self) -> &str {
        &self.face
    }

    /// How wide a word is at a size, both in points.
    pub(super) fn width(&self, text: &str, size: f64) -> f64 {
        let escaped = quick_xml::escape::escape(text);
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"><text font-family=\"Arimo\" font-size=\"100\" \
             xml:space=\"preserve\">{escaped}</text></svg>"
        );
        let measured =
            Tree::from_str(&svg, &self.options).map(|tree| f64::from(tree.root().abs_bounding_box().width()));
        match measured {
            Ok(width) if width.is_finite() => width * size / 100.0,
            // letters that the font lacks are as wide as a wide one
            _ => text.chars().count() as f64 * size,
        }
    }

    /// A word cut to a width, with an ellipsis where it is longer.
    pub(super) fn fitting(&self, text: &str, size: f64, most: f64) -> String {
        if self.width(text, size) <= most {
            return text.to_owned();
        }
        let letters: Vec<char> = text.chars().collect();
        let cut = |length: usize| letters[..length].iter().collect::<String>().trim_end().to_owned() + "\u{2026}";
        let lengths: Vec<usize> = (0..letters.len()).collect();
        let fits = lengths.partition_point(|length| self.width(&cut(*length), size) <= most);
        cut(fits.saturating_sub(1))
    }

    /// The pixels of an SVG as a PNG that says how large they are.
    ///
    /// # Errors
    /// [`PixelsError`].
    pub(super) fn png(&self, svg: &str) -> Result<Vec<u8>, PixelsError> {
        let tree = Tree::from_str(svg, &self.options)?;
        let size = tree.size().to_int_size();
        let mut pixels = Pixmap::new(size.width(), size.height()).ok_or(PixelsError::NoSize)?;
        pixels.fill(Color::WHITE);
        resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
        // nothing shines through: the alpha is left out
        let rgb: Vec<u8> = pixels
            .data()
            .chunks_exact(4)
            .flat_map(|rgba| [rgba[0], rgba[1], rgba[2]])
            .collect();
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, size.width(), size.height());
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Fast);
        // without it a figure is shown at any size
        let pixels_m = (f64::from(DPI) / 0.0254).round() as u32;
        encoder.set_pixel_dims(Some(PixelDimensions {
            xppu: pixels_m,
            yppu: pixels_m,
            unit: Unit::Meter,
        }));
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&rgb)?;
        writer.finish()?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_have_the_width_that_the_font_gives_them() {
        let letters = Letters::new();
        // Arial's digits are 0.556 em wide
        let ten = letters.width("0000000000", 8.0);
        assert!((ten - 10.0 * 0.556 * 8.0).abs() < 0.05 * 8.0, "{ten}");
        assert!(letters.width("wide & <b>", 8.0) > letters.width("wide", 8.0));
        let cut = letters.fitting(&"long ".repeat(20), 8.0, 60.0);
        assert!(
            cut.ends_with('\u{2026}') && letters.width(&cut, 8.0) <= 60.0 && cut.len() > 8,
            "{cut}"
        );
    }
}
