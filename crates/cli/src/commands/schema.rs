//! `pontoon schema`: the JSON Schema of a file, and the columns of tables. Both are JSON in either format.

use crate::args::{SchemaArguments, SchemaOf};
use crate::exit_status::ExitStatus;
use crate::text;
use anyhow::Result;

/// Writes a schema.
pub(crate) fn schema(arguments: &SchemaArguments) -> Result<ExitStatus> {
    let schema = match arguments.of {
        SchemaOf::Study => pontoon_plan::schema::study(),
        SchemaOf::Bridge => pontoon_plan::schema::bridge(),
        SchemaOf::Water => pontoon_plan::schema::water(),
        SchemaOf::Vehicle => pontoon_plan::schema::vehicle(),
        SchemaOf::Parameters => pontoon_judge::schema::parameters(),
        SchemaOf::Tables => pontoon_results::registered(),
        SchemaOf::Reference => pontoon_judge::schema::reference(),
    };
    text::result(&format!("{schema:#}\n"))?;
    Ok(ExitStatus::Good)
}
