//! The elements of an SVG, one after the other.
//!
//! Knows XML. Does not know figures. Lengths are in points, from the upper left corner.

use super::letters::{FAMILY, Letters};
use super::style::{Fill, Marker};
use quick_xml::Writer;
use quick_xml::events::{BytesEnd, BytesStart, BytesText, Event};
use std::io;

/// Points in a millimetre.
pub(super) const PT_MM: f64 = 72.0 / 25.4;

/// Where a text stands to its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    /// It begins there.
    Start,
    /// It is centred there.
    Middle,
    /// It ends there.
    End,
}

/// How something is stroked.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stroke<'a> {
    /// Its colour.
    pub colour: &'a str,
    /// Its width `[pt]`.
    pub width: f64,
    /// Its dashes; empty where it is drawn through.
    pub dashes: &'a str,
}

/// Writes an SVG.
pub(super) struct Pen {
    writer: Writer<Vec<u8>>,
}

/// Digits behind the point of a length: a thousandth of a point.
fn n(length: f64) -> String {
    let text = format!("{length:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Text that XML can hold: a blank for each letter that it cannot.
fn fit_for_xml(text: &str) -> String {
    let bad = |c: char| c.is_control() || ['\u{fffe}', '\u{ffff}'].contains(&c);
    text.chars().map(|c| if bad(c) { ' ' } else { c }).collect()
}

impl Pen {
    /// Begins an SVG of a size on white. `described` is what it shows, for those who cannot see it.
    pub(super) fn new(width: f64, height: f64, described: &str, letters: &Letters) -> io::Result<Self> {
        let mut pen = Self {
            writer: Writer::new(Vec::new()),
        };
        let (w, h) = (n(width), n(height));
        let mut svg = BytesStart::new("svg");
        svg.push_attribute(("xmlns", "http://www.w3.org/2000/svg"));
        svg.push_attribute(("width", format!("{}mm", n(width / PT_MM)).as_str()));
        svg.push_attribute(("height", format!("{}mm", n(height / PT_MM)).as_str()));
        svg.push_attribute(("viewBox", format!("0 0 {w} {h}").as_str()));
        svg.push_attribute(("role", "img"));
        svg.push_attribute(("font-family", FAMILY));
        pen.event(Event::Start(svg))?;
        pen.words("desc", &[], described)?;
        pen.words("style", &[], letters.face())?;
        pen.empty("rect", &[("width", &w), ("height", &h), ("fill", "#ffffff")])?;
        Ok(pen)
    }

    /// Ends it.
    pub(super) fn end(mut self) -> io::Result<String> {
        self.event(Event::End(BytesEnd::new("svg")))?;
        String::from_utf8(self.writer.into_inner()).map_err(io::Error::other)
    }

    fn event(&mut self, event: Event<'_>) -> io::Result<()> {
        self.writer.write_event(event)
    }

    fn element(name: &'static str, attributes: &[(&str, &str)]) -> BytesStart<'static> {
        let mut start = BytesStart::new(name);
        for (key, value) in attributes {
            start.push_attribute((*key, fit_for_xml(value).as_str()));
        }
        start
    }

    fn empty(&mut self, name: &'static str, attributes: &[(&str, &str)]) -> io::Result<()> {
        self.event(Event::Empty(Self::element(name, attributes)))
    }

    fn words(&mut self, name: &'static str, attributes: &[(&str, &str)], text: &str) -> io::Result<()> {
        self.event(Event::Start(Self::element(name, attributes)))?;
        self.event(Event::Text(BytesText::new(&fit_for_xml(text))))?;
        self.event(Event::End(BytesEnd::new(name)))
    }

    /// Begins a group of a class.
    pub(super) fn group(&mut self, class: &str) -> io::Result<()> {
        self.event(Event::Start(Self::element("g", &[("class", class)])))
    }

    /// Begins a group that shows inside a rectangle alone; `id` is unlike any other's.
    pub(super) fn clipped(&mut self, id: &str, [x, y, width, height]: [f64; 4]) -> io::Result<()> {
        self.event(Event::Start(Self::element("clipPath", &[("id", id)])))?;
        let of = [("x", n(x)), ("y", n(y)), ("width", n(width)), ("height", n(height))];
        self.empty("rect", &of.each_ref().map(|(key, value)| (*key, value.as_str())))?;
        self.event(Event::End(BytesEnd::new("clipPath")))?;
        let place = format!("url(#{id})");
        self.event(Event::Start(Self::element("g", &[("clip-path", &place)])))
    }

    /// Ends a group.
    pub(super) fn end_group(&mut self) -> io::Result<()> {
        self.event(Event::End(BytesEnd::new("g")))
    }

    /// A line through points.
    pub(super) fn line(&mut self, points: &[[f64; 2]], stroke: Stroke<'_>) -> io::Result<()> {
        let d: Vec<String> = points.iter().map(|[x, y]| format!("{} {}", n(*x), n(*y))).collect();
        self.path(&format!("M{}", d.join("L")), "none", stroke)
    }

    fn path(&mut self, d: &str, fill: &str, stroke: Stroke<'_>) -> io::Result<()> {
        let width = n(stroke.width);
        let mut attributes = vec![
            ("d", d),
            ("fill", fill),
            ("stroke", stroke.colour),
            ("stroke-width", &width),
            ("stroke-linejoin", "round"),
        ];
        if !stroke.dashes.is_empty() {
            attributes.push(("stroke-dasharray", stroke.dashes));
        }
        self.empty("path", &attributes)
    }

    /// A rectangle that is not filled.
    pub(super) fn frame(&mut self, [x, y, width, height]: [f64; 4], stroke: Stroke<'_>) -> io::Result<()> {
        let corners = [[x, y], [x + width, y], [x + width, y + height], [x, y + height], [x, y]];
        self.line(&corners, stroke)
    }

    /// A marker; `through` where what lies below it is to be seen.
    pub(super) fn marker(
        &mut self,
        marker: Marker,
        [x, y]: [f64; 2],
        radius: f64,
        colour: &str,
        through: bool,
    ) -> io::Result<()> {
        let (outline, fill) = marker.path(radius);
        if outline.is_empty() {
            let of = [
                ("cx", n(x)),
                ("cy", n(y)),
                ("r", n(0.8 * radius)),
                ("fill", colour.to_owned()),
            ];
            return self.empty("circle", &of.each_ref().map(|(key, value)| (*key, value.as_str())));
        }
        let part = |points: &Vec<[f64; 2]>| {
            let d: Vec<String> = points
                .iter()
                .map(|[a, b]| format!("{} {}", n(x + a), n(y + b)))
                .collect();
            let close = if fill == Fill::None { "" } else { "Z" };
            format!("M{}{close}", d.join("L"))
        };
        let d: String = outline.iter().map(part).collect();
        let fill = match fill {
            Fill::Colour => colour,
            Fill::White if !through => "#ffffff",
            Fill::White | Fill::None => "none",
        };
        let stroke = Stroke {
            colour,
            width: 0.8,
            dashes: "",
        };
        self.path(&d, fill, stroke)
    }

    /// A star of five points: what an experiment left is filled, what a reference expects is open.
    pub(super) fn star(&mut self, [x, y]: [f64; 2], radius: f64, filled: bool) -> io::Result<()> {
        let corner = |i: u32| {
            let (r, angle) = (
                if i.is_multiple_of(2) { radius } else { 0.42 * radius },
                std::f64::consts::PI * (f64::from(i) / 5.0 - 0.5),
            );
            format!("{} {}", n(x + r * angle.cos()), n(y + r * angle.sin()))
        };
        let d = format!("M{}Z", (0..10).map(corner).collect::<Vec<_>>().join("L"));
        let stroke = Stroke {
            colour: "#000000",
            width: 0.7,
            dashes: "",
        };
        self.path(&d, if filled { "#000000" } else { "#ffffff" }, stroke)
    }

    /// An upright bar, where marks would hide what they are compared with.
    pub(super) fn bar(&mut self, [x, y]: [f64; 2], half: f64) -> io::Result<()> {
        let stroke = Stroke {
            colour: "#000000",
            width: 1.1,
            dashes: "",
        };
        self.line(&[[x, y - half], [x, y + half]], stroke)
    }

    /// A word with its baseline at a place.
    pub(super) fn text(
        &mut self,
        [x, y]: [f64; 2],
        size: f64,
        anchor: Anchor,
        colour: &str,
        text: &str,
    ) -> io::Result<()> {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let (x, y, size) = (n(x), n(y), n(size));
        let attributes = [
            ("x", x.as_str()),
            ("y", &y),
            ("font-size", &size),
            ("text-anchor", anchor),
            ("fill", colour),
        ];
        self.words("text", &attributes, text)
    }

    /// A word that reads upward, centred at a place.
    pub(super) fn upward(&mut self, [x, y]: [f64; 2], size: f64, text: &str) -> io::Result<()> {
        let (turned, size) = (format!("translate({} {}) rotate(-90)", n(x), n(y)), n(size));
        let attributes = [
            ("transform", turned.as_str()),
            ("font-size", &size),
            ("text-anchor", "middle"),
            ("fill", "#000000"),
        ];
        self.words("text", &attributes, text)
    }
}
