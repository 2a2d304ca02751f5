mod linear_complementarity;
mod profile;
