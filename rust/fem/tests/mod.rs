mod element_and_mesh;
mod jacobian;
