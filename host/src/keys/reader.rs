//! From values to types, by serde; what is wrong is said in the words of the file, not of the program.
//!
//! A text where a table with the key `type` is expected stands for the table that has only this key: `x_min = "wall"`.

use super::source::Source;
use super::value::{Misfit, PlacedValue, Value};
use crate::error::Error;
use serde::Deserialize;
use serde::de::value::StrDeserializer;
use serde::de::{self, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Unexpected, Visitor};
use std::fmt::Display;
use std::ops::Range;

/// Reads a value as a type; `place` is the key of `node`, empty for a whole file.
///
/// # Errors
/// A key that is missing or not known, a value of the wrong kind: with the place in `source`.
pub fn read<T: for<'de> Deserialize<'de>>(source: &Source, node: &PlacedValue, place: &str) -> crate::error::Result<T> {
    let reader = Reader { node, key: place.to_owned() };
    T::deserialize(&reader).map_err(|e| reader.place(e)).map_err(|wrong| {
        let key = wrong.key.unwrap_or_default();
        let reason = if key.is_empty() { wrong.reason } else { format!("key {key}: {}", wrong.reason) };
        match wrong.span {
            Some(span) => source.error(span, reason),
            None => source.at_end(reason),
        }
    })
}

/// An error of [`PlacedValue`] as one of the file.
#[must_use]
pub fn misfit(source: &Source, (span, reason): Misfit) -> Error {
    match span {
        Some(span) => source.error(span, reason),
        None => Error::file(source.path, reason),
    }
}

/// What is wrong, and where as soon as that is known.
#[derive(Debug)]
pub struct Wrong {
    key: Option<String>,
    span: Option<Range<usize>>,
    reason: String,
}

impl Display for Wrong {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.reason)
    }
}

impl std::error::Error for Wrong {}

impl de::Error for Wrong {
    fn custom<T: Display>(reason: T) -> Self {
        Wrong { key: None, span: None, reason: reason.to_string() }
    }

    fn invalid_type(found: Unexpected, wanted: &dyn de::Expected) -> Self {
        Wrong::custom(format!("takes {wanted}, not {}", kind(&found)))
    }

    fn unknown_field(field: &str, known: &'static [&'static str]) -> Self {
        Wrong::custom(not_known(field, known))
    }

    fn unknown_variant(word: &str, known: &'static [&'static str]) -> Self {
        Wrong::custom(format!("\"{word}\" is not known: {}{}", known.join(", "), meant(word, known)))
    }

    fn missing_field(field: &'static str) -> Self {
        Wrong::custom(format!("{field} is missing"))
    }
}

/// As [`Value::kind`], of what serde found.
fn kind(found: &Unexpected) -> &'static str {
    match found {
        Unexpected::Bool(_) => "a truth value",
        Unexpected::Unsigned(_) | Unexpected::Signed(_) => "a whole number",
        Unexpected::Float(_) => "a number",
        Unexpected::Str(_) | Unexpected::Char(_) => "a text",
        Unexpected::Seq => "a list",
        Unexpected::Map => "a table",
        _ => "something else",
    }
}

/// That a key is not known, what may be meant, and what is.
#[must_use]
pub fn not_known(key: &str, known: &[&str]) -> String {
    format!("is not known here{} (known: {})", meant(key, known), known.join(", "))
}

/// What may be meant by a word, as the end of a sentence; nothing, if none of those known is near.
#[must_use]
pub fn meant(typed: &str, known: &[&str]) -> String {
    let velocity = ["u", "v", "w"];
    if typed == "velocity" && velocity.iter().all(|u| known.contains(u)) {
        return "; did you mean u, v, w, the velocities along x, y, z?".to_owned();
    }
    nearest(typed, known).map_or_else(String::new, |near| format!("; did you mean {near}?"))
}

/// Words that others use, and ours.
const OTHERS_SAY: [(&str, &str); 31] = [
    ("pipe", "cylinder"),
    ("tube", "cylinder"),
    ("rod", "cylinder"),
    ("ball", "sphere"),
    ("cuboid", "box"),
    ("block", "box"),
    ("cube", "box"),
    ("elbow", "torus"),
    ("bend", "torus"),
    ("ring", "torus"),
    ("frustum", "cone"),
    ("stl", "file"),
    ("mesh", "file"),
    ("outflow", "outlet"),
    ("inflow", "inlet"),
    ("open", "outlet"),
    ("opening", "outlet"),
    ("vent", "outlet"),
    ("ambient", "outlet"),
    ("atmosphere", "outlet"),
    ("pressure-outlet", "outlet"),
    ("stagnation", "reservoir"),
    ("total-pressure", "reservoir"),
    ("freestream", "far-field"),
    ("slip", "wall"),
    ("symmetry", "wall"),
    ("extrapolate", "zero-gradient"),
    ("temperature", "T"),
    ("pressure", "p"),
    ("density", "rho"),
    ("centre", "center"),
];

/// The known word that means what was typed, whatever its case, or differs least from it, if it differs little.
#[must_use]
pub fn nearest<'a>(typed: &str, known: &[&'a str]) -> Option<&'a str> {
    let same = |word: &&str| OTHERS_SAY.contains(&(&typed.to_lowercase()[..], word));
    let in_other_case = |word: &&str| word.eq_ignore_ascii_case(typed);
    if let Some(word) = known.iter().copied().find(same).or_else(|| known.iter().copied().find(in_other_case)) {
        return Some(word);
    }
    let far = |word: &str| (distance(typed, word), word.len());
    let near = known.iter().copied().min_by_key(|word| far(word))?;
    let (apart, letters) = (far(near).0, typed.chars().count());
    (apart <= 1 + letters / 4 && apart < letters).then_some(near)
}

/// Letters to insert, delete, replace or swap with their neighbour to make one word of the other (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

/// A value with its key.
struct Reader<'a> {
    node: &'a PlacedValue,
    key: String,
}

impl Reader<'_> {
    /// The value is not what was wanted.
    fn takes(&self, wanted: &str) -> Wrong {
        self.place(de::Error::custom(format!("takes {wanted}, not {}", self.node.value.kind())))
    }

    /// Gives an error without a place that of this value.
    fn place(&self, wrong: Wrong) -> Wrong {
        match wrong.key {
            Some(_) => wrong,
            None => Wrong { key: Some(self.key.clone()), span: self.node.span.clone(), ..wrong },
        }
    }

    fn number(&self) -> Result<f64, Wrong> {
        match self.node.value {
            Value::Number(x) => Ok(x),
            Value::Whole(n) => Ok(n as f64),
            _ => Err(self.takes("a number")),
        }
    }

    /// A whole number of a type that holds those from `low` to `high`.
    fn whole(&self, low: i128, high: i128) -> Result<i128, Wrong> {
        match self.node.value {
            Value::Whole(n) if (low..=high).contains(&n) => Ok(n),
            Value::Whole(n) if n < 0 && low == 0 => {
                Err(self.place(de::Error::custom(format!("takes a whole number from 0, not {n}"))))
            }
            Value::Whole(n) => {
                Err(self.place(de::Error::custom(format!("takes a whole number up to {high}, not {n}"))))
            }
            Value::Number(x) => {
                let hint = if x.fract() == 0.0 { ": without a point or an exponent" } else { "" };
                Err(self.place(de::Error::custom(format!("takes a whole number, not {x:?}{hint}"))))
            }
            _ => Err(self.takes("a whole number")),
        }
    }

    /// The value is a table under a head such as `[boundary.patch]`, and not one in braces.
    fn is_under_a_head(&self) -> bool {
        let known = |entry: &super::value::Entry| Some((self.node.span.as_ref()?.end, entry.node.span.as_ref()?.end));
        match &self.node.value {
            Value::Table(entries) => entries.iter().filter_map(known).any(|(table, last)| last > table),
            _ => false,
        }
    }

    fn member(&self, key: &str) -> String {
        if self.key.is_empty() { key.to_owned() } else { format!("{}.{key}", self.key) }
    }
}

/// The one key that a text may stand for.
const TYPE: &str = "type";

macro_rules! whole_numbers {
    ($($method:ident $visit:ident $type:ty;)*) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
            let n = self.whole(<$type>::MIN as i128, <$type>::MAX as i128)?;
            visitor.$visit(n as $type).map_err(|e| self.place(e)) // it is within the type
        }
    )*};
}

impl<'de> Deserializer<'de> for &Reader<'_> {
    type Error = Wrong;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        let read = match &self.node.value {
            Value::Text(text) | Value::Date(text) => visitor.visit_str(text),
            Value::Whole(n) => match i64::try_from(*n) {
                Ok(n) => visitor.visit_i64(n),
                Err(_) => visitor.visit_f64(*n as f64),
            },
            Value::Number(x) => visitor.visit_f64(*x),
            Value::Truth(truth) => visitor.visit_bool(*truth),
            Value::List(items) => visitor.visit_seq(Items { items: items.iter().enumerate(), list: self }),
            Value::Table(entries) => {
                let entries = entries.iter().map(|e| (&e.key[..], e.span.clone(), &e.node)).collect::<Vec<_>>();
                visitor.visit_map(Members { entries: entries.into_iter(), value: None, table: self })
            }
            Value::Null => visitor.visit_unit(),
        };
        read.map_err(|e| self.place(e))
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.node.value {
            Value::Truth(truth) => visitor.visit_bool(truth),
            _ => Err(self.takes("true or false")),
        }
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_f64(self.number()?)
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_f64(self.number()?)
    }

    whole_numbers! {
        deserialize_u8 visit_u8 u8;
        deserialize_u16 visit_u16 u16;
        deserialize_u32 visit_u32 u32;
        deserialize_u64 visit_u64 u64;
        deserialize_i8 visit_i8 i8;
        deserialize_i16 visit_i16 i16;
        deserialize_i32 visit_i32 i32;
        deserialize_i64 visit_i64 i64;
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match &self.node.value {
            Value::Text(text) => visitor.visit_str(text).map_err(|e| self.place(e)),
            _ => Err(self.takes("a text")),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.deserialize_str(visitor)
    }

    fn deserialize_char<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.deserialize_str(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.node.value {
            Value::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.node.value {
            Value::List(_) => self.deserialize_any(visitor),
            Value::Table(_) if self.is_under_a_head() => {
                let reason =
                    format!("takes a list: each of its tables has a head with two pairs of brackets, [[{}]]", self.key);
                Err(self.place(de::Error::custom(reason)))
            }
            _ => Err(self.takes("a list, in brackets")),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Wrong> {
        match &self.node.value {
            Value::List(items) if items.len() == length => self.deserialize_any(visitor),
            Value::List(items) => {
                Err(self.place(de::Error::custom(format!("takes {length} values, not {}", items.len()))))
            }
            other => {
                let reason = format!("takes a list of {length} values, not {}", other.kind());
                Err(self.place(de::Error::custom(reason)))
            }
        }
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        self.deserialize_tuple(length, visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.node.value {
            Value::Table(_) => self.deserialize_any(visitor),
            _ => Err(self.takes("a table")),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        match &self.node.value {
            Value::Table(_) => self.deserialize_any(visitor),
            Value::Text(_) if fields.contains(&TYPE) => {
                let entries = vec![(TYPE, None, self.node)];
                visitor.visit_map(Members { entries: entries.into_iter(), value: None, table: self })
            }
            other => {
                let reason = format!("takes a table with any of {}, not {}", fields.join(", "), other.kind());
                Err(self.place(de::Error::custom(reason)))
            }
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        words: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        match &self.node.value {
            Value::Text(word) => {
                let word: StrDeserializer<Wrong> = StrDeserializer::new(word);
                visitor.visit_enum(word).map_err(|e| self.place(e))
            }
            other => {
                let reason = format!("takes one of the words {}, not {}", words.join(", "), other.kind());
                Err(self.place(de::Error::custom(reason)))
            }
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_newtype_struct(self)
    }

    serde::forward_to_deserialize_any! { bytes byte_buf unit unit_struct ignored_any }
}

/// The values of a list, one after the other.
struct Items<'a> {
    items: std::iter::Enumerate<std::slice::Iter<'a, PlacedValue>>,
    list: &'a Reader<'a>,
}

impl<'de> SeqAccess<'de> for Items<'_> {
    type Error = Wrong;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Wrong> {
        let Some((n, node)) = self.items.next() else { return Ok(None) };
        let reader = Reader { node, key: format!("{}[{n}]", self.list.key) };
        seed.deserialize(&reader).map(Some).map_err(|e| reader.place(e))
    }
}

/// A key, where it stands, its value.
type Member<'a> = (&'a str, Option<Range<usize>>, &'a PlacedValue);

/// The keys and values of a table, one after the other.
struct Members<'a> {
    entries: std::vec::IntoIter<Member<'a>>,
    value: Option<Reader<'a>>,
    table: &'a Reader<'a>,
}

impl<'de> MapAccess<'de> for Members<'_> {
    type Error = Wrong;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Wrong> {
        let Some((key, span, node)) = self.entries.next() else { return Ok(None) };
        let path = self.table.member(key);
        let found = seed.deserialize(StrDeserializer::new(key)).map_err(|wrong: Wrong| Wrong {
            key: Some(path.clone()),
            span,
            ..wrong
        })?;
        self.value = Some(Reader { node, key: path });
        Ok(Some(found))
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, Wrong> {
        let reader = self.value.take().ok_or_else(|| <Wrong as de::Error>::custom("a value without a key"))?;
        seed.deserialize(&reader).map_err(|e| reader.place(e))
    }
}
