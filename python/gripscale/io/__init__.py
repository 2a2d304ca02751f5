"""Text tables, spreadsheets and netCDF files."""
