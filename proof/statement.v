(* SPDX-License-Identifier: Apache-2.0 *)
(** What a certificate of contacts claims (docs/cpp/certificates.md), for readers. [checker.v] is a program;
    [soundness.v] proves that a claim which it accepts [holds] in the sense of the last definition of this file. *)
Require Import ZArith QArith List.
Open Scope Q_scope.

(** * Numbers and points *)

(** m * 2^e. Every finite double is such a number. *)
Record number := Number { mantissa : Z; exponent : Z }.
Definition value (n : number) : Q := inject_Z (mantissa n) * Qpower 2 (exponent n).

Record triple (T : Type) := Triple { x : T; y : T; z : T }.
Arguments Triple {T}. Arguments x {T}. Arguments y {T}. Arguments z {T}.
Definition point := triple Q.

(** * Meshes and poses *)

(** A mesh is a list of faces. A face has the vertices of a triangle or a quad and its number in the file; a polygon
    of the file that was cut gives several faces of one number. *)
Record face := Face { number_in_file : Z; vertices : list (triple number) }.
Definition mesh := list face.

(** A pose maps v to R v + t: each row of it has the entries of R and the one of t. R may be any matrix. *)
Record row := Row { entries : triple number; shift : number }.
Definition pose := triple row.

Definition coordinate (r : row) (v : triple number) : Q :=
  value (x (entries r)) * value (x v) + value (y (entries r)) * value (y v)
  + value (z (entries r)) * value (z v) + value (shift r).
Definition posed (p : pose) (v : triple number) : point :=
  Triple (coordinate (x p) v) (coordinate (y p) v) (coordinate (z p) v).

(** The vertices of a face in its pose. *)
Definition placed (p : pose) (f : face) : list point := map (posed p) (vertices f).

(** * Faces as sets of points *)

Fixpoint sum (ws : list Q) : Q := match ws with nil => 0 | w :: rest => w + sum rest end.
Fixpoint weighted (ws vs : list Q) : Q :=
  match ws, vs with w :: ws, v :: vs => w * v + weighted ws vs | _, _ => 0 end.

(** p lies in the hull of the points vs: it is a mean of them with weights of which none is negative. *)
Definition hull (vs : list point) (p : point) : Prop :=
  exists ws, length ws = length vs /\ (forall w, In w ws -> 0 <= w) /\ sum ws == 1 /\
    weighted ws (map x vs) == x p /\ weighted ws (map y vs) == y p /\ weighted ws (map z vs) == z p.

(** The hull of vs and that of us, moved by t, have a point in common. *)
Definition meet_moved (t : point) (vs us : list point) : Prop :=
  exists p q, hull vs p /\ hull us q /\ x p == x q + x t /\ y p == y q + y t /\ z p == z q + z t.

(** All coordinates of t are less than eps in absolute value. *)
Definition shorter (eps : Q) (t : point) : Prop :=
  (- eps < x t /\ x t < eps) /\ (- eps < y t /\ y t < eps) /\ (- eps < z t /\ z t < eps).

Definition meet (vs us : list point) : Prop := meet_moved (Triple 0 0 0) vs us.
(** Every translation that is short enough leaves them in contact. *)
Definition cross (vs us : list point) : Prop :=
  exists eps, 0 < eps /\ forall t, shorter eps t -> meet_moved t vs us.
(** They meet, and among the translations that are shorter than any eps there is one that parts them. *)
Definition touch (vs us : list point) : Prop :=
  meet vs us /\ forall eps, 0 < eps -> exists t, shorter eps t /\ ~ meet_moved t vs us.
(** They have points at most w apart; less than w, if [strict]. *)
Definition near (w : Q) (strict : bool) (vs us : list point) : Prop :=
  exists p q, hull vs p /\ hull us q /\
    let square := (x p - x q) * (x p - x q) + (y p - y q) * (y p - y q) + (z p - z q) * (z p - z q) in
    if strict then square < w * w else square <= w * w.
(** They meet after the second is moved by some positive multiple of t. *)
Definition meet_along (t : point) (vs us : list point) : Prop :=
  exists k, 0 < k /\ meet_moved (Triple (k * x t) (k * y t) (k * z t)) vs us.

(** * Two meshes in their poses *)

Record scene := Scene { mesh_a : mesh; pose_a : pose; mesh_b : mesh; pose_b : pose }.

(** Faces i of file A and j of file B: some of their parts are in the relation. *)
Definition some_parts (related : list point -> list point -> Prop) (s : scene) (i j : Z) : Prop :=
  exists f g, In f (mesh_a s) /\ In g (mesh_b s) /\ number_in_file f = i /\ number_in_file g = j /\
    related (placed (pose_a s) f) (placed (pose_b s) g).
Definition faces_meet := some_parts meet.
Definition faces_cross := some_parts cross.

(** * The claim of a certificate *)

(** What counts as a contact. If [Along t] has none, B moved by any positive multiple of t does not meet A. *)
Inductive criterion := Meeting | CrossingOnly | Within (w : number) | Below (w : number) | Along (t : triple number).
Definition counts_as_contact (k : criterion) : list point -> list point -> Prop :=
  match k with
  | Meeting => meet | CrossingOnly => cross
  | Within w => near (value w) false | Below w => near (value w) true
  | Along t => meet_along (Triple (value (x t)) (value (y t)) (value (z t)))
  end.

Inductive relation := Apart | Touching | Crossing.
Record contact := Contact { face_a : Z; face_b : Z; told : option relation }.
Record claim := Claim {
  all : bool;                         (* the contacts are all there are *)
  counted : criterion;
  relation_of_meshes : option relation;
  contacts : list contact }.

Definition is_contact (c : claim) := some_parts (counts_as_contact (counted c)).

Definition contact_holds (c : claim) (s : scene) (k : contact) : Prop :=
  is_contact c s (face_a k) (face_b k) /\
  match told k with
  | None => True
  | Some Apart => False
  | Some Touching => faces_meet s (face_a k) (face_b k) /\ ~ faces_cross s (face_a k) (face_b k)
  | Some Crossing => faces_cross s (face_a k) (face_b k)
  end.

Definition relation_holds (s : scene) (r : relation) : Prop :=
  match r with
  | Apart => forall i j, ~ faces_meet s i j
  | Touching => (exists i j, faces_meet s i j) /\ forall i j, ~ faces_cross s i j
  | Crossing => exists i j, faces_cross s i j
  end.

Definition holds (c : claim) (s : scene) : Prop :=
  (forall k, In k (contacts c) -> contact_holds c s k) /\
  NoDup (map (fun k => (face_a k, face_b k)) (contacts c)) /\
  (if all c then forall i j, is_contact c s i j -> exists k, In k (contacts c) /\ face_a k = i /\ face_b k = j
   else length (contacts c) = 1%nat) /\
  match relation_of_meshes c with None => True | Some r => relation_holds s r end.
