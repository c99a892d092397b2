(* SPDX-License-Identifier: Apache-2.0 *)
(** The checker of certificates (docs/cpp/certificates.md), a program over integers. *)
Require Import ZArith List Bool Mergesort Orders.
From Certificates Require Import statement.
Import ListNotations.
Open Scope Z_scope.

(** * Certificates *)

Inductive side := SideA | SideB.
Record edge := Edge { edge_of : side; edge_to : nat }.
Inductive reason :=
| Meet
| Near
| Touch (direction : triple Z)
| Cross (e1 e2 e3 : edge).
Inductive cell :=
| Split (which : side) (at_ : option Z) (* none: in halves *)
| Separated (direction : triple Z)
| Shared (index_a index_b : Z) (weights_a weights_b : list Z) (why : reason).

Record certificate := Certificate {
  claimed : claim;
  halving : bool; (* the orders are those of trees, whose sets are cut in halves *)
  order_a : list Z;
  order_b : list Z;
  cells : list cell }.

(** * Vertices as integers: all are multiplied by the same power of two *)

Definition whole (e : Z) (n : number) : Z :=
  if mantissa n =? 0 then 0 else Z.shiftl (mantissa n) (exponent n - e).
(** m 2^e is a multiple of 2^e0. *)
Definition fits (e : Z) (n : number) : bool := (mantissa n =? 0) || (e <=? exponent n).
Definition least_exponent (ns : list number) : option Z :=
  fold_left (fun e n => if mantissa n =? 0 then e
                        else match e with None => Some (exponent n) | Some e => Some (Z.min e (exponent n)) end) ns None.

Definition items {T} (t : triple T) : list T := [x t; y t; z t].
Definition map3 {S T} (f : S -> T) (t : triple S) : triple T := Triple (f (x t)) (f (y t)) (f (z t)).
Definition dot (d p : triple Z) : Z := x d * x p + y d * y p + z d * z p.

Record part := Part { index : Z; number_of : Z; corners : list (triple Z) }.

Definition coordinate_z (r : triple Z * Z) (v : triple Z) : Z := dot (fst r) v + snd r.
Definition posed_z (p : triple (triple Z * Z)) (v : triple Z) : triple Z :=
  map3 (fun r => coordinate_z r v) p.
(** Coordinates of the mesh are multiplied by 2^-ev, those of the matrix by 2^-er. *)
Definition whole_pose (ev er : Z) (p : pose) : triple (triple Z * Z) :=
  map3 (fun r => (map3 (whole er) (entries r), whole (ev + er) (shift r))) p.
Fixpoint place (ev i : Z) (m : mesh) : list part :=
  match m with
  | [] => []
  | f :: rest => Part i (number_in_file f) (map (map3 (whole ev)) (vertices f)) :: place ev (i + 1) rest
  end.
(** Corners are posed before the cells are read, or, if few of them are asked for, [late], at the cells. *)
Definition posed_early (late : bool) (p : triple (triple Z * Z)) (ps : list part) : list part :=
  if late then ps else map (fun f => Part (index f) (number_of f) (map (posed_z p) (corners f))) ps.
Definition posed_late (late : bool) (p : triple (triple Z * Z)) (v : triple Z) : triple Z :=
  if late then posed_z p v else v.

Definition numbers_of_mesh (m : mesh) : list number := flat_map (fun f => flat_map items (vertices f)) m.
Definition matrix_of (p : pose) : list number := flat_map (fun r => items (entries r)) (items p).
Definition shifts_of (p : pose) : list number := map shift (items p).
Definition or_zero (e : option Z) : Z := match e with None => 0 | Some e => e end.
Definition least_of_two (a b : option Z) : option Z :=
  match a, b with None, e => e | e, None => e | Some a, Some b => Some (Z.min a b) end.

(** Numbers of the scale of the vertices in their poses. *)
Definition distances_of (k : criterion) : list number := match k with Within w | Below w => [w] | _ => [] end.
Definition exponent_of_meshes (a b : mesh) : Z :=
  or_zero (least_of_two (least_exponent (numbers_of_mesh a)) (least_exponent (numbers_of_mesh b))).
Definition exponent_of_rows (ev : Z) (pa pb : pose) (k : criterion) : Z :=
  let er := least_exponent (matrix_of pa ++ matrix_of pb) in
  let et := least_exponent (shifts_of pa ++ shifts_of pb ++ distances_of k) in
  or_zero (least_of_two er (match et with None => None | Some e => Some (e - ev) end)).

Definition fits_mesh (ev : Z) (m : mesh) : bool :=
  forallb (fun f => forallb (fun v => forallb (fits ev) (items v)) (vertices f)) m.
Definition fits_pose (ev er : Z) (p : pose) : bool :=
  forallb (fun r => forallb (fits er) (items (entries r)) && fits (ev + er) (shift r)) (items p).

(** [criterion] in integers: in the scale of the vertices in their poses; a translation may have any scale. *)
Inductive measure := Sharing | Distance (w : Z) (strict : bool) | Moving (t : triple Z).
Definition scale_of (t : triple number) : Z := or_zero (least_exponent (items t)).
Definition measure_of (e : Z) (k : criterion) : measure :=
  match k with
  | Meeting | CrossingOnly => Sharing
  | Within w => Distance (whole e w) false
  | Below w => Distance (whole e w) true
  | Along t => Moving (map3 (whole (scale_of t)) t)
  end.
Definition fits_criterion (e : Z) (k : criterion) : bool :=
  match k with
  | Meeting | CrossingOnly => true
  | Within w | Below w => fits e w
  | Along t => forallb (fits (scale_of t)) (items t)
  end.

(** Triangles and quads only. *)
Definition is_shape (f : face) : bool :=
  match vertices f with [_; _; _] | [_; _; _; _] => true | _ => false end.

(** * Cells *)

Definition is_zero (d : triple Z) : bool := (x d =? 0) && (y d =? 0) && (z d =? 0).

Definition highest (d : triple Z) (ps : list (triple Z)) : option Z :=
  fold_left (fun top p => match top with None => Some (dot d p) | Some v => Some (Z.max v (dot d p)) end) ps None.
(** Along d all points ps lie below all points qs: [below v w] compares. *)
Definition all_below (below : Z -> Z -> bool) (d : triple Z) (ps qs : list (triple Z)) : bool :=
  negb (is_zero d) &&
  match highest d ps with None => false | Some top => forallb (fun q => below top (dot d q)) qs end.

(** Does d part the points as the measure wants it? *)
Definition separates (m : measure) (d : triple Z) (ps qs : list (triple Z)) : bool :=
  match m with
  | Sharing => all_below Z.ltb d ps qs
  | Distance w strict =>
    let least := w * w * dot d d in
    all_below (fun top v => let gap := v - top in
      (0 <? gap) && if strict then least <=? gap * gap else least <? gap * gap) d ps qs
  | Moving t =>
    let rise := dot d t in
    if 0 <? rise then all_below Z.leb d ps qs else (rise =? 0) && all_below Z.ltb d ps qs
  end.

Fixpoint sum_z (ws : list Z) : Z := match ws with [] => 0 | w :: rest => w + sum_z rest end.
Fixpoint weighted_z (ws vs : list Z) : Z :=
  match ws, vs with w :: ws, v :: vs => w * v + weighted_z ws vs | _, _ => 0 end.
Fixpoint same_length {S T} (l : list S) (m : list T) : bool :=
  match l, m with [], [] => true | _ :: l, _ :: m => same_length l m | _, _ => false end.

Definition same_point (wa wb : list Z) (pa pb : list (triple Z)) : bool :=
  let ta := sum_z wa in
  let tb := sum_z wb in
  (0 <? ta) && (0 <? tb) && same_length wa pa && same_length wb pb &&
  (weighted_z wa (map x pa) * tb =? weighted_z wb (map x pb) * ta) &&
  (weighted_z wa (map y pa) * tb =? weighted_z wb (map y pb) * ta) &&
  (weighted_z wa (map z pa) * tb =? weighted_z wb (map z pb) * ta).

(** The difference of the two points, times both sums of weights. *)
Definition close_points (w : Z) (strict : bool) (wa wb : list Z) (pa pb : list (triple Z)) : bool :=
  let ta := sum_z wa in
  let tb := sum_z wb in
  let difference := fun coordinates : triple Z -> Z =>
    weighted_z wa (map coordinates pa) * tb - weighted_z wb (map coordinates pb) * ta in
  let d := Triple (difference x) (difference y) (difference z) in
  let most := w * ta * tb in
  (0 <? ta) && (0 <? tb) && same_length wa pa && same_length wb pb &&
  if strict then dot d d <? most * most else dot d d <=? most * most.

Definition vector (pa pb : list (triple Z)) (e : edge) : option (triple Z) :=
  let ps := match edge_of e with SideA => pa | SideB => pb end in
  match nth_error ps 0, nth_error ps (edge_to e) with
  | Some p, Some q => Some (Triple (x q - x p) (y q - y p) (z q - z p))
  | _, _ => None
  end.
Definition determinant (a b c : triple Z) : Z :=
  x a * (y b * z c - z b * y c) + y a * (z b * x c - x b * z c) + z a * (x b * y c - y b * x c).

Definition at_least (least : Z) (ws : list Z) : bool := forallb (fun w => least <=? w) ws.

Definition reason_holds (m : measure) (why : reason) (wa wb : list Z) (pa pb : list (triple Z)) : bool :=
  match m, why with
  | Sharing, Meet => same_point wa wb pa pb && at_least 0 wa && at_least 0 wb
  | Sharing, Touch d => same_point wa wb pa pb && at_least 0 wa && at_least 0 wb && all_below Z.leb d pa pb
  | Distance w strict, Near => at_least 0 wa && at_least 0 wb && close_points w strict wa wb pa pb
  | Sharing, Cross e1 e2 e3 =>
    same_point wa wb pa pb && at_least 1 wa && at_least 1 wb &&
    match vector pa pb e1, vector pa pb e2, vector pa pb e3 with
    | Some a, Some b, Some c => negb (determinant a b c =? 0)
    | _, _, _ => false
    end
  | _, _ => false
  end.

Inductive kind := Meets | Touches | Crosses.
Record entry := Entry { key_a : Z; key_b : Z; kind_of : kind }.
Definition kind_of_reason (why : reason) : kind :=
  match why with Meet | Near => Meets | Touch _ => Touches | Cross _ _ _ => Crosses end.

(** * Sets of faces *)

(** A node holds the number of its parts, and the least and the greatest coordinates of their corners. *)
Inductive tree := Leaf (p : part) | Node (size : Z) (low high : triple Z) (first second : tree).
(** Parts at the places [from], [from] + 1, ... of an order, or those of a tree. *)
Inductive group := Places (from : Z) (members : list part) | Tree (t : tree).

Fixpoint leaves (t : tree) : list part := match t with Leaf p => [p] | Node _ _ _ a b => leaves a ++ leaves b end.
Definition parts (g : group) : list part := match g with Places _ ps => ps | Tree t => leaves t end.
Definition only (g : group) : option part := match g with Places _ [p] | Tree (Leaf p) => Some p | _ => None end.

Definition map_two (f : Z -> Z -> Z) (a b : triple Z) : triple Z := Triple (f (x a) (x b)) (f (y a) (y b)) (f (z a) (z b)).
Definition bounds (t : tree) : triple Z * triple Z :=
  match t with
  | Leaf p => match corners p with
              | [] => (Triple 0 0 0, Triple 0 0 0)
              | v :: vs => (fold_left (map_two Z.min) vs v, fold_left (map_two Z.max) vs v)
              end
  | Node _ low high _ _ => (low, high)
  end.
Definition node (size : Z) (a b : tree) : tree :=
  let (la, ha) := bounds a in let (lb, hb) := bounds b in Node size (map_two Z.min la lb) (map_two Z.max ha hb) a b.

(** The tree of the first n parts, and the parts after them. *)
Fixpoint grow (levels : nat) (n : Z) (ps : list part) : option (tree * list part) :=
  match levels, ps with
  | S levels, p :: rest =>
    if n =? 1 then Some (Leaf p, rest)
    else let half := Z.shiftl n (-1) in
      match grow levels half ps with
      | Some (a, rest) =>
        match grow levels (n - half) rest with Some (b, rest) => Some (node n a b, rest) | None => None end
      | None => None
      end
  | _, _ => None
  end.

Definition eight (low high : triple Z) : list (triple Z) :=
  flat_map (fun u => flat_map (fun v => [Triple u v (z low); Triple u v (z high)]) [y low; y high]) [x low; x high].
(** Points whose hull holds all corners of a tree: for each part after [halvings] of them the corners of its box, or, if
    it has at most four leaves, all corners of these. *)
Fixpoint outer_tree (halvings : nat) (t : tree) {struct t} : list (triple Z) :=
  match t with
  | Leaf p => corners p
  | Node size low high a b =>
    if 4 <? size
    then match halvings with O => eight low high | S fewer => outer_tree fewer a ++ outer_tree fewer b end
    else flat_map corners (leaves t)
  end.
Definition outer (g : group) : list (triple Z) :=
  match g with Places _ ps => flat_map corners ps | Tree t => outer_tree 3 t end.

(** The first n of a list, in reverse before [taken], and the rest. *)
Fixpoint cut {T} (n : Z) (taken rest : list T) : list T * list T :=
  if n <=? 0 then (taken, rest)
  else match rest with [] => (taken, []) | a :: rest => cut (n - 1) (a :: taken) rest end.

Definition divide (g : group) (at_ : option Z) : option (group * group) :=
  match g, at_ with
  | Places from ps, Some at_ =>
    match cut (at_ - from) [] ps with
    | (a :: first, b :: second) => Some (Places from (rev_append (a :: first) []), Places at_ (b :: second))
    | _ => None
    end
  | Tree (Node _ _ _ a b), None => Some (Tree a, Tree b)
  | _, _ => None
  end.

Inductive outcome := Done (found : list entry) | Failed (from_cell : list cell).

Section Cells.
  (** How corners are posed that are not yet. *)
  Variables (m : measure) (move_a move_b : triple Z -> triple Z).

  (** What one cell leaves to prove, and the entries that it finds. *)
  Definition step (c : cell) (ga gb : group) : option (list (group * group) * list entry) :=
    match c with
    | Split SideA at_ =>
      match divide ga at_ with Some (first, second) => Some ([(first, gb); (second, gb)], []) | None => None end
    | Split SideB at_ =>
      match divide gb at_ with Some (first, second) => Some ([(ga, first); (ga, second)], []) | None => None end
    | Separated d =>
      if separates m d (map move_a (outer ga)) (map move_b (outer gb)) then Some ([], []) else None
    | Shared i j wa wb why =>
      match only ga, only gb with
      | Some f, Some g =>
        if (index f =? i) && (index g =? j) &&
           reason_holds m why wa wb (map move_a (corners f)) (map move_b (corners g))
        then Some ([], [Entry (number_of f) (number_of g) (kind_of_reason why)]) else None
      | _, _ => None
      end
    end.

  Fixpoint run (cs : list cell) (todo : list (group * group)) (found : list entry) : outcome :=
    match cs, todo with
    | [], [] => Done found
    | c :: rest, (ga, gb) :: todo =>
      match step c ga gb with
      | Some (more, entries) => run rest (more ++ todo) (entries ++ found)
      | None => Failed cs
      end
    | _, _ => Failed cs
    end.
End Cells.

(** * Orders *)

Module PlaceOrder <: TotalLeBool.
  Definition t := (Z * Z)%type.
  Definition leb (a b : t) := fst a <=? fst b.
  Theorem leb_total : forall a b, leb a b = true \/ leb b a = true.
  Proof. intros a b. unfold leb. rewrite !Z.leb_le. destruct (Z.le_ge_cases (fst a) (fst b)); auto. Qed.
End PlaceOrder.
Module PlaceSort := Sort PlaceOrder.

Module PartOrder <: TotalLeBool.
  Definition t := (Z * part)%type.
  Definition leb (a b : t) := fst a <=? fst b.
  Theorem leb_total : forall a b, leb a b = true \/ leb b a = true.
  Proof. intros a b. unfold leb. rewrite !Z.leb_le. destruct (Z.le_ge_cases (fst a) (fst b)); auto. Qed.
End PartOrder.
Module PartSort := Sort PartOrder.

Fixpoint numbered {T} (i : Z) (l : list T) : list (T * Z) :=
  match l with [] => [] | a :: rest => (a, i) :: numbered (i + 1) rest end.
(** Are these i, i + 1, ... for each of the parts, and no more? *)
Fixpoint counts {T} (i : Z) (l : list (Z * T)) (ps : list part) : bool :=
  match l, ps with
  | [], [] => true
  | (a, _) :: l, _ :: ps => (a =? i) && counts (i + 1) l ps
  | _, _ => false
  end.

(** The parts in the order of the certificate: the place of each part, then the parts by places. *)
Definition ordered (order : list Z) (ps : list part) : option (list part) :=
  let places := PlaceSort.sort (numbered 0 order) in
  match ps with
  | [] => None
  | _ => if counts 0 places ps then Some (map snd (PartSort.sort (combine (map snd places) ps))) else None
  end.

Definition listed (order : list Z) (ps : list part) : option group :=
  match ordered order ps with Some sorted => Some (Places 0 sorted) | None => None end.
(** At most 2^40 parts. *)
Definition grown (order : list Z) (ps : list part) : option group :=
  match ordered order ps with
  | None => None
  | Some sorted =>
    match grow 41 (fold_left (fun n _ => n + 1) sorted 0) sorted with Some (t, []) => Some (Tree t) | _ => None end
  end.
Definition both (a b : option group) : option (group * group) :=
  match a, b with Some a, Some b => Some (a, b) | _, _ => None end.

(** * The claim *)

Module EntryOrder <: TotalLeBool.
  Definition t := entry.
  Definition leb (a b : t) := (key_a a <? key_a b) || ((key_a a =? key_a b) && (key_b a <=? key_b b)).
  Theorem leb_total : forall a b, leb a b = true \/ leb b a = true.
  Proof.
    intros a b. unfold leb. rewrite !orb_true_iff, !andb_true_iff, !Z.ltb_lt, !Z.eqb_eq, !Z.leb_le.
    destruct (Z.lt_trichotomy (key_a a) (key_a b)) as [H | [H | H]]; auto.
    destruct (Z.le_ge_cases (key_b a) (key_b b)); auto.
  Qed.
End EntryOrder.
Module EntrySort := Sort EntryOrder.

(** All entries of two faces of the files. *)
Record pair_found := PairFound { pair_a : Z; pair_b : Z; crosses : bool; meets_only : bool }.

Definition add_entry (e : entry) (gs : list pair_found) : list pair_found :=
  let c := match kind_of e with Crosses => true | _ => false end in
  let m := match kind_of e with Meets => true | _ => false end in
  match gs with
  | g :: rest =>
    if (key_a e =? pair_a g) && (key_b e =? pair_b g)
    then PairFound (pair_a g) (pair_b g) (c || crosses g) (m || meets_only g) :: rest
    else PairFound (key_a e) (key_b e) c m :: gs
  | [] => [PairFound (key_a e) (key_b e) c m]
  end.
(** The accumulator has the greatest pair first: [found] must be sorted, greatest first. *)
Definition pairs_of (found : list entry) : list pair_found :=
  fold_left (fun gs e => add_entry e gs) (rev_append (EntrySort.sort found) []) [].

Fixpoint ascend (gs : list pair_found) : bool :=
  match gs with
  | g :: ((h :: _) as rest) =>
    ((pair_a g <? pair_a h) || ((pair_a g =? pair_a h) && (pair_b g <? pair_b h))) && ascend rest
  | _ => true
  end.

Definition only_crossing (c : claim) : bool := match counted c with CrossingOnly => true | _ => false end.
(** Relations are told only of faces that meet. *)
Definition about_meeting (c : claim) : bool := match counted c with Meeting | CrossingOnly => true | _ => false end.
Definition is_untold (c : claim) : bool :=
  match relation_of_meshes c with None => true | Some _ => false end &&
  forallb (fun k => match told k with None => true | Some _ => false end) (contacts c).

Definition is_told (c : claim) (g : pair_found) : bool := crosses g || (all c && negb (meets_only g)).
Definition is_counted (c : claim) (g : pair_found) : bool := negb (only_crossing c) || crosses g.

Definition fulfils (c : claim) (g : pair_found) (k : contact) : bool :=
  (face_a k =? pair_a g) && (face_b k =? pair_b g) &&
  match told k with
  | None => true
  | Some Apart => false
  | Some Touching => is_told c g && negb (crosses g)
  | Some Crossing => crosses g
  end.
Fixpoint all_fulfil (c : claim) (gs : list pair_found) (ks : list contact) : bool :=
  match gs, ks with
  | [], [] => true
  | g :: gs, k :: ks => fulfils c g k && all_fulfil c gs ks
  | _, _ => false
  end.

Definition claim_follows (c : claim) (gs : list pair_found) : bool :=
  ascend gs && (about_meeting c || is_untold c) &&
  (negb (only_crossing c) || forallb (is_told c) gs) &&
  all_fulfil c (filter (is_counted c) gs) (contacts c) &&
  match relation_of_meshes c with
  | None => true
  | Some Crossing => existsb crosses gs
  | Some Touching => all c && match gs with [] => false | _ => true end
                     && forallb (fun g => is_told c g && negb (crosses g)) gs
  | Some Apart => all c && match gs with [] => true | _ => false end
  end.

(** * All together *)

Inductive verdict :=
| Accepted
| ScaleFault | ShapeFault | OrderFault | CellsFault (from_cell : list cell) | ClaimFault.

Definition conclude (c : certificate) (o : outcome) : verdict :=
  match o with
  | Failed rest => CellsFault rest
  | Done found => if claim_follows (claimed c) (pairs_of found) then Accepted else ClaimFault
  end.

(** What is made once for two meshes, in all poses: their scale, whether it fits and the faces are of the right shape,
    the parts; and their trees, if a certificate cites them. *)
Record prepared := Prepared { scale : Z; is_scaled : bool; is_shaped : bool; parts_a : list part; parts_b : list part }.
Definition prepare (a b : mesh) : prepared :=
  let ev := exponent_of_meshes a b in
  Prepared ev (fits_mesh ev a && fits_mesh ev b) (forallb is_shape a && forallb is_shape b) (place ev 0 a) (place ev 0 b).
Definition trees_of (p : prepared) (order_a order_b : list Z) : option (group * group) :=
  both (grown order_a (parts_a p)) (grown order_b (parts_b p)).

Definition check_parts (m : measure) (move_a move_b : triple Z -> triple Z) (trees : option (group * group))
    (c : certificate) (pa pb : list part) : verdict :=
  if all (claimed c) then
    match (if halving c then trees else both (listed (order_a c) pa) (listed (order_b c) pb)) with
    | Some sets => conclude c (run m move_a move_b (cells c) [sets] [])
    | None => OrderFault
    end
  else
    match order_a c, order_b c, cells c, contacts (claimed c) with
    | [], [], [Shared i j _ _ _], [_] =>
      match find (fun f => index f =? i) pa, find (fun g => index g =? j) pb with
      | Some f, Some g => conclude c (run m move_a move_b (cells c) [(Places 0 [f], Places 0 [g])] [])
      | _, _ => CellsFault (cells c)
      end
    | _, _, _, _ => OrderFault
    end.

Definition check_prepared (p : prepared) (trees : option (group * group)) (pa pb : pose) (c : certificate) : verdict :=
  let k := counted (claimed c) in
  let ev := scale p in
  let er := exponent_of_rows ev pa pb k in
  let late := halving c || negb (all (claimed c)) in
  let wa := whole_pose ev er pa in
  let wb := whole_pose ev er pb in
  if negb (is_scaled p && fits_pose ev er pa && fits_pose ev er pb && fits_criterion (ev + er) k) then ScaleFault
  else if negb (is_shaped p) then ShapeFault
  else check_parts (measure_of (ev + er) k) (posed_late late wa) (posed_late late wb) trees c
                   (posed_early late wa (parts_a p)) (posed_early late wb (parts_b p)).

Definition check (s : scene) (c : certificate) : verdict :=
  let p := prepare (mesh_a s) (mesh_b s) in
  check_prepared p (if halving c then trees_of p (order_a c) (order_b c) else None) (pose_a s) (pose_b s) c.
