//! Numbers in the text of a configuration file: read and replaced by their keys, with comments and order as they were.
//!
//! A key is the path to the number, as in `model.com_height`; the components of a list are counted from 0, as in
//! `step.by_speed.3.1`, and tables in a list as well, as in `push.0.force.1`.

use toml_edit::{DocumentMut, Item, TableLike, Value};

/// The number at `key`.
///
/// # Errors
/// There is none.
pub fn number_at(text: &str, key: &str) -> Result<f64, String> {
    let mut document = parsed(text)?;
    let value = find(&mut document, key)?;
    Ok(match value {
        Value::Integer(n) => *n.value() as f64,
        Value::Float(x) => *x.value(),
        other => return Err(format!("{key}: is of type {}, not a number", other.type_name())),
    })
}

/// The text with other numbers at these keys.
///
/// # Errors
/// There is no number at one of them.
pub fn with_numbers<'a>(
    text: &str,
    numbers: impl IntoIterator<Item = (&'a str, f64)>,
) -> Result<String, String> {
    let mut document = parsed(text)?;
    for (key, number) in numbers {
        let value = find(&mut document, key)?;
        let other = match value {
            Value::Integer(_) if number.fract() == 0.0 => Value::from(number as i64),
            Value::Integer(_) | Value::Float(_) => Value::from(number),
            other => return Err(format!("{key}: is of type {}, not a number", other.type_name())),
        };
        let decor = value.decor().clone();
        *value = other;
        *value.decor_mut() = decor;
    }
    Ok(document.to_string())
}

fn parsed(text: &str) -> Result<DocumentMut, String> {
    text.parse().map_err(|e| format!("not TOML: {e}"))
}

fn find<'d>(document: &'d mut DocumentMut, key: &str) -> Result<&'d mut Value, String> {
    let mut keys = key.split('.');
    let mut table: &mut dyn TableLike = document.as_table_mut();
    // Tables, and tables in lists, down to a value ...
    let mut value = loop {
        let next = keys.next().ok_or_else(|| format!("{key}: is a table; name one of its keys"))?;
        table = match table.get_mut(next) {
            Some(Item::Value(Value::InlineTable(table))) => table,
            Some(Item::Value(value)) => break value,
            Some(Item::Table(table)) => table,
            Some(Item::ArrayOfTables(all)) => {
                let (count, next) = (all.len(), keys.next().unwrap_or_default());
                component(next).and_then(|k| all.get_mut(k)).ok_or_else(|| no_component(key, next, count))?
            }
            Some(Item::None) | None => return Err(format!("{key}: there is no `{next}`")),
        };
    };
    // ... and components within it.
    for next in keys {
        let count = value.as_array().map_or(0, toml_edit::Array::len);
        value = component(next)
            .and_then(|k| value.as_array_mut()?.get_mut(k))
            .ok_or_else(|| no_component(key, next, count))?;
    }
    Ok(value)
}

/// Number of a component, written in one way only: `1`, neither `+1` nor `01`.
fn component(text: &str) -> Option<usize> {
    text.parse().ok().filter(|k: &usize| k.to_string() == text)
}

fn no_component(key: &str, next: &str, count: usize) -> String {
    format!("{key}: `{next}` is no component; there are {count}, counted from 0")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# A gait.\n[step]\nwidth = 0.21 # [m]\nrows = [\n    [0.0, 1], # slow\n    [2.5, 0.457],\n]\n[model]\nlegs = 3\nname = \"a\"\n";

    #[test]
    fn numbers_are_replaced_and_all_else_is_as_it_was() {
        let edits = [("step.width", 0.25), ("step.rows.1.1", 0.5), ("model.legs", 4.0)];
        let text = with_numbers(TEXT, edits).unwrap();
        let expected = TEXT.replace("0.21", "0.25").replace("0.457", "0.5").replace("legs = 3", "legs = 4");
        assert_eq!(text, expected);
        for (key, number) in edits {
            assert_eq!(number_at(&text, key), Ok(number));
        }
        assert_eq!(with_numbers(TEXT, []).unwrap(), TEXT);
    }

    #[test]
    fn tables_in_lists_and_in_braces_have_numbers_too() {
        let text = "[[push]]\ntime = 1.0\n[[push]]\ntime = 2.0 # [s]\nat = { x = 3 }\n";
        assert_eq!(number_at(text, "push.1.time"), Ok(2.0));
        let edited = with_numbers(text, [("push.1.time", 2.5), ("push.1.at.x", 4.0)]).unwrap();
        assert_eq!(edited, text.replace("2.0", "2.5").replace("3", "4"));
        let why = "push.2.time: `2` is no component; there are 2, counted from 0";
        assert_eq!(number_at(text, "push.2.time").unwrap_err(), why);
        assert_eq!(number_at(text, "push.0").unwrap_err(), "push.0: is a table; name one of its keys");
    }

    #[test]
    fn a_key_without_a_number_is_named() {
        for (key, why) in [
            ("step.witdh", "step.witdh: there is no `witdh`"),
            ("step", "step: is a table; name one of its keys"),
            ("step.rows.2.0", "step.rows.2.0: `2` is no component; there are 2, counted from 0"),
            ("step.rows.x", "step.rows.x: `x` is no component; there are 2, counted from 0"),
            ("step.rows.01.0", "step.rows.01.0: `01` is no component; there are 2, counted from 0"),
            ("step.rows.+1.0", "step.rows.+1.0: `+1` is no component; there are 2, counted from 0"),
            ("step.rows", "step.rows: is of type array, not a number"),
            ("model.name", "model.name: is of type string, not a number"),
            ("step.width.0", "step.width.0: `0` is no component; there are 0, counted from 0"),
        ] {
            assert_eq!(number_at(TEXT, key).unwrap_err(), why);
            assert_eq!(with_numbers(TEXT, [(key, 1.0)]).unwrap_err(), why);
        }
    }
}
