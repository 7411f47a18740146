//! `pontoon schema`: the JSON Schema of a file. A schema is JSON in either format.

use crate::Ending;
use crate::args::{SchemaArguments, SchemaOf};
use crate::words;
use anyhow::Result;

/// Writes a schema.
pub fn schema(arguments: &SchemaArguments) -> Result<Ending> {
    let schema = match arguments.of {
        SchemaOf::Study => pontoon_study::schema::study(),
        SchemaOf::Bridge => pontoon_study::schema::bridge(),
        SchemaOf::Parameters => pontoon_study::schema::parameters(),
        SchemaOf::Reference => pontoon_study::schema::reference(),
    };
    words::result(&format!("{schema:#}\n"))?;
    Ok(Ending::Good)
}
