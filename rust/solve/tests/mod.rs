mod mesh_sequence;
mod profile_continuation;
mod sparse_step;
