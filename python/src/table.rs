//! Tables of results by columns, in read-only memory that numpy and Arrow share.

use crate::stream;
use arrow_array::{Array, ArrayRef, Float64Array, RecordBatch, RecordBatchIterator, StringArray, UInt64Array};
use arrow_buffer::{NullBuffer, ScalarBuffer};
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::{PyIndexError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};
use std::collections::HashMap;
use std::sync::Arc;

/// The key of a column's unit in the metadata of its field.
const UNIT: &str = "unit";

/// The name, unit and type of a column; the unit is empty if its values have none.
#[derive(Clone)]
pub struct Header {
    pub name: String,
    pub unit: String,
    pub kind: Kind,
}

/// The type of a column's values.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Numbers,
    Integers,
    Words,
}

/// The values of a column.
#[derive(Clone)]
pub enum Values {
    Numbers(ScalarBuffer<f64>),
    Integers(ScalarBuffer<u64>),
    Words(StringArray),
}

impl Values {
    fn kind(&self) -> Kind {
        match self {
            Values::Numbers(_) => Kind::Numbers,
            Values::Integers(_) => Kind::Integers,
            Values::Words(_) => Kind::Words,
        }
    }

    fn len(&self) -> usize {
        match self {
            Values::Numbers(values) => values.len(),
            Values::Integers(values) => values.len(),
            Values::Words(values) => values.len(),
        }
    }

    /// Returns the values as an Arrow array, in which numbers that are not finite are null; `may_have_gaps` false skips the search for these.
    fn array(&self, may_have_gaps: bool) -> ArrayRef {
        match self {
            Values::Numbers(values) => {
                let nulls = if !may_have_gaps || values.iter().all(|value| value.is_finite()) {
                    None
                } else {
                    Some(values.iter().map(|value| value.is_finite()).collect::<NullBuffer>())
                };
                Arc::new(Float64Array::new(values.clone(), nulls))
            }
            Values::Integers(values) => Arc::new(UInt64Array::new(values.clone(), None)),
            Values::Words(values) => Arc::new(values.clone()),
        }
    }
}

/// Returns the Arrow schema of columns.
pub fn schema(headers: &[Header]) -> SchemaRef {
    let field = |header: &Header| {
        let (kind, has_gaps) = match header.kind {
            Kind::Numbers => (DataType::Float64, true),
            Kind::Integers => (DataType::UInt64, false),
            Kind::Words => (DataType::Utf8, false),
        };
        let field = Field::new(&header.name, kind, has_gaps);
        if header.unit.is_empty() {
            field
        } else {
            field.with_metadata(HashMap::from([(UNIT.to_owned(), header.unit.clone())]))
        }
    };
    Arc::new(Schema::new(headers.iter().map(field).collect::<Vec<_>>()))
}

/// Returns columns as a batch of Arrow; `gaps` are the columns in which numbers may be missing.
pub fn batch(schema: &SchemaRef, columns: &[Values], gaps: &[bool]) -> Result<RecordBatch, arrow_schema::ArrowError> {
    let arrays = columns.iter().zip(gaps).map(|(values, &may_have_gaps)| values.array(may_have_gaps));
    RecordBatch::try_new(Arc::clone(schema), arrays.collect())
}

/// A read-only column, which `numpy.asarray(column)` takes without a copy.
#[pyclass(frozen, module = "mechc._mechc")]
pub struct Column {
    values: Values,
}

#[pymethods]
impl Column {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (kind, address) = match &self.values {
            Values::Numbers(values) => ("<f8", values.as_ptr() as usize),
            Values::Integers(values) => ("<u8", values.as_ptr() as usize),
            Values::Words(_) => return Err(PyTypeError::new_err("words are no array of numbers")),
        };
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", kind)?;
        interface.set_item("shape", (self.values.len(),))?;
        interface.set_item("data", (address, true))?;
        Ok(interface)
    }

    fn __len__(&self) -> usize {
        self.values.len()
    }
}

/// Restores a column that was pickled.
fn unpickled(column: &Bound<'_, PyAny>) -> PyResult<Values> {
    if let Ok(values) = column.extract::<PyReadonlyArray1<'_, f64>>() {
        return Ok(Values::Numbers(values.as_array().to_vec().into()));
    }
    if let Ok(values) = column.extract::<PyReadonlyArray1<'_, u64>>() {
        return Ok(Values::Integers(values.as_array().to_vec().into()));
    }
    Ok(Values::Words(StringArray::from(column.extract::<Vec<String>>()?)))
}

/// A table.
#[pyclass(frozen, module = "mechc._mechc")]
pub struct Table {
    headers: Vec<Header>,
    columns: Vec<Values>,
}

impl Table {
    pub fn new(headers: Vec<Header>, columns: Vec<Values>) -> Table {
        Table { headers, columns }
    }

    /// Creates a table from columns of numbers with their units.
    pub fn of_numbers(names: Vec<String>, units: Vec<String>, columns: Vec<Vec<f64>>) -> Table {
        let headers =
            names.into_iter().zip(units).map(|(name, unit)| Header { name, unit, kind: Kind::Numbers }).collect();
        Table::new(headers, columns.into_iter().map(|values| Values::Numbers(values.into())).collect())
    }

    fn rows(&self) -> usize {
        self.columns.first().map_or(0, Values::len)
    }
}

#[pymethods]
impl Table {
    /// Creates a table from columns: arrays of numbers, lists of words.
    #[new]
    fn new_from_columns(names: Vec<String>, units: Vec<String>, columns: Vec<Bound<'_, PyAny>>) -> PyResult<Table> {
        let columns: Vec<Values> = columns.iter().map(unpickled).collect::<PyResult<_>>()?;
        let lengths = columns.iter().map(Values::len);
        if names.len() != columns.len() || units.len() != columns.len() || lengths.clone().min() != lengths.max() {
            return Err(PyValueError::new_err("names, units and columns are not of one length"));
        }
        let headers = names.into_iter().zip(units).zip(&columns);
        let headers = headers.map(|((name, unit), values)| Header { name, unit, kind: values.kind() }).collect();
        Ok(Table::new(headers, columns))
    }

    #[getter]
    fn names(&self) -> Vec<&str> {
        self.headers.iter().map(|header| header.name.as_str()).collect()
    }

    #[getter]
    fn units(&self) -> Vec<&str> {
        self.headers.iter().map(|header| header.unit.as_str()).collect()
    }

    fn __len__(&self) -> usize {
        self.rows()
    }

    /// Returns a column by its number: for numpy, or a list of words.
    fn column<'py>(&self, py: Python<'py>, number: usize) -> PyResult<Bound<'py, PyAny>> {
        match self.columns.get(number) {
            None => Err(PyIndexError::new_err(format!("there is no column {number}"))),
            Some(Values::Words(words)) => Ok(PyList::new(py, words.iter())?.into_any()),
            Some(values) => Ok(Bound::new(py, Column { values: values.clone() })?.into_any()),
        }
    }

    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        stream::schema_capsule(py, &schema(&self.headers))
    }

    #[pyo3(signature = (requested_schema = None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // the interface allows to ignore the requested schema
        let _ = requested_schema;
        let schema = schema(&self.headers);
        let batch = batch(&schema, &self.columns, &vec![true; self.columns.len()]).map_err(stream::failed)?;
        stream::capsule(py, Box::new(RecordBatchIterator::new([Ok(batch)], schema)))
    }
}
