//! A canonical text as its types read it. Its tokens were checked by `strict`, so that none has to be checked again.
//!
//! Knows JSON's types and those that a place may ask for. Does not know the types of files.

use super::path::PathStep;
use super::refusal::{FoundValue, RefusalKind};
use super::trouble::{Expected, Trouble};
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, MapAccess, SeqAccess, VariantAccess, Visitor,
    value::StrDeserializer,
};
use serde::forward_to_deserialize_any;
use serde_json::Value;
use std::borrow::Cow;

/// A canonical text under way.
pub(super) struct CanonicalReader<'de> {
    text: &'de str,
    at: usize,
}

/// A number as a canonical text has it.
enum CanonicalNumber {
    Whole(i64),
    Large(u64),
    Broken(f64),
}

impl<'de> CanonicalReader<'de> {
    /// At the beginning of a text.
    pub(super) fn new(text: &'de str) -> Self {
        Self { text, at: 0 }
    }

    /// The next character; a blank behind the end.
    fn peek(&self) -> u8 {
        self.text.as_bytes().get(self.at).copied().unwrap_or(b' ')
    }

    /// Goes past the next character.
    fn pass(&mut self) {
        self.at += 1;
    }

    /// Where the string that begins here ends, behind its quote; whether anything in it is escaped.
    fn end_of_string(&self) -> (usize, bool) {
        let (mut at, mut escaped) = (self.at + 1, false);
        let bytes = self.text.as_bytes();
        while let Some(&byte) = bytes.get(at) {
            match byte {
                b'"' => return (at + 1, escaped),
                b'\\' => {
                    escaped = true;
                    at += 2;
                }
                _ => at += 1,
            }
        }
        (bytes.len(), escaped)
    }

    fn string(&mut self) -> Cow<'de, str> {
        let (end, escaped) = self.end_of_string();
        let written = &self.text[self.at..end];
        self.at = end;
        if escaped {
            Cow::Owned(serde_json::from_str(written).unwrap_or_default())
        } else {
            Cow::Borrowed(written.trim_start_matches('"').trim_end_matches('"'))
        }
    }

    /// Where the word or number that begins here ends.
    fn end_of_token(&self) -> usize {
        let rest = &self.text.as_bytes()[self.at..];
        let length = rest.iter().position(|byte| matches!(byte, b',' | b']' | b'}' | b':'));
        self.at + length.unwrap_or(rest.len())
    }

    fn digits(&mut self) -> CanonicalNumber {
        let end = self.end_of_token();
        let written = &self.text[self.at..end];
        self.at = end;
        if let Ok(whole) = written.parse() {
            CanonicalNumber::Whole(whole)
        } else if let Ok(large) = written.parse() {
            CanonicalNumber::Large(large)
        } else {
            CanonicalNumber::Broken(written.parse().unwrap_or(f64::NAN))
        }
    }

    /// Goes past a value.
    fn skip(&mut self) {
        let mut level = 0_usize;
        loop {
            match self.peek() {
                b'"' => self.at = self.end_of_string().0,
                b'[' | b'{' => {
                    level += 1;
                    self.pass();
                }
                b']' | b'}' => {
                    level = level.saturating_sub(1);
                    self.pass();
                }
                b',' | b':' => self.pass(),
                _ => self.at = self.end_of_token(),
            }
            if level == 0 || self.at >= self.text.len() {
                return;
            }
        }
    }

    /// Number of values of the list or keys of the object that begins here.
    fn length(&self) -> usize {
        let mut ahead = CanonicalReader {
            text: self.text,
            at: self.at + 1,
        };
        let mut length = 0;
        while !matches!(ahead.peek(), b']' | b'}' | b' ') {
            ahead.skip();
            if ahead.peek() == b':' {
                ahead.pass();
                ahead.skip();
            }
            length += 1;
            if ahead.peek() == b',' {
                ahead.pass();
            }
        }
        length
    }

    /// What stands here.
    fn here(&self) -> FoundValue {
        match self.peek() {
            b'[' => "a list".into(),
            b'{' => "an object".into(),
            _ => {
                let mut ahead = CanonicalReader { ..*self };
                ahead.skip();
                let value: Value = serde_json::from_str(&self.text[self.at..ahead.at]).unwrap_or_default();
                FoundValue::value(value)
            }
        }
    }

    fn wrong(&self, expected: Expected) -> Trouble {
        Trouble::new(RefusalKind::WrongType, self.here(), expected)
    }

    fn is_number(&self) -> bool {
        matches!(self.peek(), b'-' | b'0'..=b'9')
    }

    fn whole<V: Visitor<'de>>(&mut self, expected: Expected, visitor: V) -> Result<V::Value, Trouble> {
        let begin = self.at;
        if self.is_number() {
            match self.digits() {
                CanonicalNumber::Whole(whole) if whole >= 0 => return visitor.visit_u64(whole.unsigned_abs()),
                CanonicalNumber::Whole(whole) if expected == Expected::Whole => return visitor.visit_i64(whole),
                CanonicalNumber::Large(large) => return visitor.visit_u64(large),
                CanonicalNumber::Whole(_) | CanonicalNumber::Broken(_) => {}
            }
        }
        self.at = begin;
        Err(self.wrong(expected))
    }

    fn list<V: Visitor<'de>>(&mut self, visitor: V) -> Result<V::Value, Trouble> {
        self.pass();
        let items = Items { reader: self, place: 0 };
        let read = visitor.visit_seq(items)?;
        self.pass();
        Ok(read)
    }

    fn object<V: Visitor<'de>>(&mut self, visitor: V) -> Result<V::Value, Trouble> {
        self.pass();
        let entries = Entries {
            reader: self,
            key: Cow::Borrowed(""),
        };
        let read = visitor.visit_map(entries)?;
        self.pass();
        Ok(read)
    }
}

macro_rules! whole {
    ($($name:ident)*, $expected:ident) => {
        $(fn $name<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
            self.whole(Expected::$expected, visitor)
        })*
    };
}

impl<'de> Deserializer<'de> for &mut CanonicalReader<'de> {
    type Error = Trouble;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        match self.peek() {
            b'[' => self.list(visitor),
            b'{' => self.object(visitor),
            b'"' => match self.string() {
                Cow::Borrowed(word) => visitor.visit_borrowed_str(word),
                Cow::Owned(word) => visitor.visit_string(word),
            },
            b'n' => self.deserialize_unit(visitor),
            b't' | b'f' => self.deserialize_bool(visitor),
            _ => match self.digits() {
                CanonicalNumber::Whole(whole) if whole >= 0 => visitor.visit_u64(whole.unsigned_abs()),
                CanonicalNumber::Whole(whole) => visitor.visit_i64(whole),
                CanonicalNumber::Large(large) => visitor.visit_u64(large),
                CanonicalNumber::Broken(number) => visitor.visit_f64(number),
            },
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        let flag = match self.peek() {
            b't' => true,
            b'f' => false,
            _ => return Err(self.wrong(Expected::Flag)),
        };
        self.at = self.end_of_token();
        visitor.visit_bool(flag)
    }

    whole!(deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64 deserialize_u128, NotNegativeWhole);
    whole!(deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64 deserialize_i128, Whole);

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        self.deserialize_f64(visitor)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        if !self.is_number() {
            return Err(self.wrong(Expected::Number));
        }
        match self.digits() {
            CanonicalNumber::Whole(whole) => visitor.visit_f64(whole as f64),
            CanonicalNumber::Large(large) => visitor.visit_f64(large as f64),
            CanonicalNumber::Broken(number) => visitor.visit_f64(number),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        if self.peek() != b'"' {
            return Err(self.wrong(Expected::Word));
        }
        self.deserialize_any(visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        self.deserialize_str(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        if self.peek() == b'n' {
            self.at = self.end_of_token();
            visitor.visit_none()
        } else {
            visitor.visit_some(self)
        }
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        if self.peek() != b'n' {
            return Err(self.wrong(Expected::Null));
        }
        self.at = self.end_of_token();
        visitor.visit_unit()
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Trouble> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        if self.peek() != b'[' {
            return Err(self.wrong(Expected::List));
        }
        self.list(visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Trouble> {
        if self.peek() != b'[' {
            return Err(self.wrong(Expected::ListOf(length)));
        }
        match self.length() {
            own if own == length => self.list(visitor),
            own => Err(Trouble::new(
                RefusalKind::NotAllowed,
                Expected::ListOf(own).to_string(),
                Expected::ListOf(length),
            )),
        }
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        if self.peek() != b'{' {
            return Err(self.wrong(Expected::Object));
        }
        self.object(visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Trouble> {
        self.deserialize_map(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Trouble> {
        match self.peek() {
            b'"' => {
                let word = self.string();
                visitor.visit_enum(WordVariant(word))
            }
            b'{' if self.length() == 1 => {
                self.pass();
                let read = visitor.visit_enum(KeyVariant(self))?;
                self.pass();
                Ok(read)
            }
            b'{' => {
                let found = format!("an object of {} keys", self.length());
                Err(Trouble::new(RefusalKind::NotAllowed, found, Expected::SingleKey))
            }
            _ => Err(Trouble::new(RefusalKind::WrongType, self.here(), variants.join(", "))),
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Trouble> {
        self.skip();
        visitor.visit_unit()
    }

    forward_to_deserialize_any! { char bytes byte_buf unit_struct tuple_struct }
}

/// The values of a list.
struct Items<'a, 'de> {
    reader: &'a mut CanonicalReader<'de>,
    place: usize,
}

impl<'de> SeqAccess<'de> for Items<'_, 'de> {
    type Error = Trouble;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Trouble> {
        match self.reader.peek() {
            b']' => return Ok(None),
            b',' => self.reader.pass(),
            _ => {}
        }
        let place = self.place;
        self.place += 1;
        let read = seed.deserialize(&mut *self.reader);
        read.map(Some).map_err(|trouble| trouble.under(PathStep::Place(place)))
    }
}

/// The keys of an object with their values.
struct Entries<'a, 'de> {
    reader: &'a mut CanonicalReader<'de>,
    key: Cow<'de, str>,
}

impl<'de> MapAccess<'de> for Entries<'_, 'de> {
    type Error = Trouble;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Trouble> {
        match self.reader.peek() {
            b'}' => return Ok(None),
            b',' => self.reader.pass(),
            _ => {}
        }
        self.key = self.reader.string();
        let key: StrDeserializer<'_, Trouble> = (&*self.key).into_deserializer();
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Trouble> {
        self.reader.pass();
        let read = seed.deserialize(&mut *self.reader);
        read.map_err(|trouble| trouble.under(PathStep::Key(self.key.to_string())))
    }
}

/// One of several as a word.
struct WordVariant<'de>(Cow<'de, str>);

impl<'de> EnumAccess<'de> for WordVariant<'de> {
    type Error = Trouble;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self), Trouble> {
        let word: StrDeserializer<'_, Trouble> = (&*self.0).into_deserializer();
        Ok((seed.deserialize(word)?, self))
    }
}

impl WordVariant<'_> {
    fn needs_value<T>(&self) -> Result<T, Trouble> {
        let allowed = format!("an object {{ \"{}\": .. }}", self.0);
        Err(Trouble::new(
            RefusalKind::WrongType,
            FoundValue::value(&*self.0),
            allowed,
        ))
    }
}

impl<'de> VariantAccess<'de> for WordVariant<'de> {
    type Error = Trouble;

    fn unit_variant(self) -> Result<(), Trouble> {
        Ok(())
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, _: S) -> Result<S::Value, Trouble> {
        self.needs_value()
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Trouble> {
        self.needs_value()
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], _: V) -> Result<V::Value, Trouble> {
        self.needs_value()
    }
}

/// One of several as the only key of an object.
struct KeyVariant<'a, 'de>(&'a mut CanonicalReader<'de>);

/// The value of such a key.
struct KeyedValue<'a, 'de> {
    reader: &'a mut CanonicalReader<'de>,
    key: Cow<'de, str>,
}

impl<'a, 'de> EnumAccess<'de> for KeyVariant<'a, 'de> {
    type Error = Trouble;
    type Variant = KeyedValue<'a, 'de>;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self::Variant), Trouble> {
        let key = self.0.string();
        let word: StrDeserializer<'_, Trouble> = (&*key).into_deserializer();
        let read = seed.deserialize(word).map_err(|trouble| trouble.of_key(&key))?;
        self.0.pass();
        Ok((read, KeyedValue { reader: self.0, key }))
    }
}

impl<'de> VariantAccess<'de> for KeyedValue<'_, 'de> {
    type Error = Trouble;

    fn unit_variant(self) -> Result<(), Trouble> {
        let Self { reader, key } = self;
        if reader.peek() == b'n' {
            reader.skip();
            return Ok(());
        }
        let found = reader.here();
        reader.skip();
        let allowed = format!("the word \"{key}\"");
        Err(Trouble::new(RefusalKind::WrongType, found, allowed).under(PathStep::Key(key.to_string())))
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, Trouble> {
        let Self { reader, key } = self;
        let read = seed.deserialize(&mut *reader);
        read.map_err(|trouble| trouble.under(PathStep::Key(key.to_string())))
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Trouble> {
        let Self { reader, key } = self;
        let read = reader.deserialize_tuple(length, visitor);
        read.map_err(|trouble| trouble.under(PathStep::Key(key.to_string())))
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Trouble> {
        let Self { reader, key } = self;
        let read = reader.deserialize_map(visitor);
        read.map_err(|trouble| trouble.under(PathStep::Key(key.to_string())))
    }
}
