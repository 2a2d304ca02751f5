"""Tests of the chain, its dataset, report and case file; a package so that they share stand-ins."""
