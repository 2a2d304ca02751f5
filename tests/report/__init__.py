"""Tests of the HTML report; a package so that they share the results and the reader of pages."""
