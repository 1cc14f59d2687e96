//! Writers of porosity fields.
