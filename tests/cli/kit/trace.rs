//! The keys that a type reads, found by letting it read: a deserializer that records what it is asked for.

use serde::de::value::StrDeserializer;
use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, forward_to_deserialize_any};
use std::cell::RefCell;
use std::collections::BTreeMap;

type Refusal = serde::de::value::Error;

/// Tables by their path; in each the keys, with the words that a key may hold.
type Tables = BTreeMap<String, BTreeMap<String, Vec<&'static str>>>;

/// The tables that `T` reads; `root` is the path of `T`. What is read as any kind of value counts as a list.
pub fn tables<T: for<'de> Deserialize<'de>>(root: &str) -> Tables {
    let found = RefCell::new(Tables::new());
    let ask = Ask { path: root.to_owned(), key: None, found: &found };
    if let Err(error) = T::deserialize(ask) {
        panic!("{root} cannot be read: {error}");
    }
    found.into_inner()
}

/// A value that is whatever it is asked for.
struct Ask<'a> {
    path: String,
    /// The table that it is in, and its key.
    key: Option<(String, &'static str)>,
    found: &'a RefCell<Tables>,
}

impl<'de> Deserializer<'de> for Ask<'_> {
    type Error = Refusal;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        self.deserialize_seq(visitor)
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_bool(true)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_f64(1.0)
    }

    fn deserialize_i64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_i64(1)
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_u64(1)
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_u64(1)
    }

    fn deserialize_u8<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_u64(1)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_str("text")
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_str("text")
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_some(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_seq(Asks { left: 1, of: self })
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_seq(Asks { left: length, of: self })
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        let keys = fields.iter().map(|&key| (key.to_owned(), Vec::new())).collect();
        self.found.borrow_mut().insert(self.path.clone(), keys);
        visitor.visit_map(Fields { left: fields.iter(), key: "", of: self })
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        words: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        if let Some((table, key)) = &self.key {
            let mut found = self.found.borrow_mut();
            found.get_mut(table).and_then(|t| t.get_mut(*key)).expect("a key").extend(words);
        }
        visitor.visit_enum(StrDeserializer::new(words[0]))
    }

    forward_to_deserialize_any! {
        i8 i16 i32 u16 f32 char bytes byte_buf unit unit_struct newtype_struct tuple_struct map identifier ignored_any
    }
}

/// A list.
struct Asks<'a> {
    left: usize,
    of: Ask<'a>,
}

impl<'de> SeqAccess<'de> for Asks<'_> {
    type Error = Refusal;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Refusal> {
        if self.left == 0 {
            return Ok(None);
        }
        self.left -= 1;
        let Ask { path, key, found } = &self.of;
        seed.deserialize(Ask { path: format!("{path}[]"), key: key.clone(), found }).map(Some)
    }
}

/// A table that has every key.
struct Fields<'a> {
    left: std::slice::Iter<'static, &'static str>,
    key: &'static str,
    of: Ask<'a>,
}

impl<'de> MapAccess<'de> for Fields<'_> {
    type Error = Refusal;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Refusal> {
        let Some(key) = self.left.next() else { return Ok(None) };
        self.key = key;
        seed.deserialize(StrDeserializer::new(key)).map(Some)
    }

    fn next_value_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<T::Value, Refusal> {
        let Ask { path, found, .. } = &self.of;
        let key = Some((path.clone(), self.key));
        seed.deserialize(Ask { path: format!("{path}.{}", self.key), key, found })
    }
}
