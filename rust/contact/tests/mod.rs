mod linear_complementarity;
mod profile;
mod sampling;
