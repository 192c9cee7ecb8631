"""Shape libraries: records, names, sizes and support surfaces of CAD shapes."""
