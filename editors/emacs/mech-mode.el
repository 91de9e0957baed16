;;; mech-mode.el --- Planar mechanisms as mechc reads them  -*- lexical-binding: t; -*-

;; Version: 0.1.0
;; Package-Requires: ((emacs "28.1"))
;; Keywords: languages

;;; Commentary:

;; Colours, comments and indentation of .mech files; `M-x eglot' starts `mechc lsp'.

;;; Code:

;; <words lists>
(defconst mech-mode-declarations
  '("mechanism" "param" "fn" "table" "ground" "body" "point" "axis" "circle" "curve" "joint" "driver"
    "constraint" "measure" "analysis")
  "Words of the language.")
(defconst mech-mode-formula
  '("if" "then" "else" "and" "or" "not")
  "Words of the language.")
(defconst mech-mode-openers
  '("use" "load" "trace" "result" "input" "part")
  "Words of the language.")
(defconst mech-mode-places
  '("mass" "gravity" "require" "to" "every" "within" "along" "at" "toward" "radius" "inertia" "from" "on"
    "spline" "in" "mirrored" "as" "columns" "periodic")
  "Words of the language.")
(defconst mech-mode-sides
  '("left" "right" "crossed")
  "Words of the language.")
(defconst mech-mode-joints
  '("revolute" "translational" "weld" "revolute_revolute" "revolute_translational" "gear" "internal_gear"
    "belt" "rack_pinion" "point_follower" "cam" "flat_follower")
  "Words of the language.")
(defconst mech-mode-called
  '("abs" "acos" "angle" "argmax" "argmin" "asin" "at" "atan" "atan2" "cos" "cosh" "curvature" "cycloidal"
    "der" "direction" "displacement" "distance" "effort" "exp" "first" "force_x" "force_y" "harmonic" "hypot"
    "integral" "last" "length" "ln" "log10" "max" "mean" "mid" "min" "mod" "modsine" "polar" "pole_x"
    "pole_y" "poly" "pressure_angle" "rms" "rotation" "sign" "sin" "sinh" "slip" "speed" "sqrt" "step"
    "step5" "step7" "tan" "tanh" "torque" "x" "y")
  "Words of the language.")
(defconst mech-mode-constants
  '("t" "pi" "tau")
  "Words of the language.")
(defconst mech-mode-units
  '("m" "mm" "cm" "um" "µm" "km" "in" "ft" "rad" "mrad" "deg" "rev" "s" "ms" "us" "µs" "Hz" "rpm" "kg" "lbm"
    "N" "kN" "lbf" "J" "W" "kW" "Pa" "kPa" "MPa" "bar")
  "Words of the language.")
;; </words>

(defun mech-mode-find-place (limit)
  "Find a word before LIMIT that stands between the parts of a declaration.
It may be a name too: where an operator follows, or a formula begins."
  (let (found)
    (while (and (not found) (re-search-forward (regexp-opt mech-mode-places 'symbols) limit t))
      (setq found (save-match-data
                    (and (looking-at-p "[ \t]+[^-+*/^=<> \t\n]\\|[ \t]*$")
                         (save-excursion
                           (goto-char (match-beginning 0))
                           (skip-chars-backward " \t")
                           (not (memq (char-before) (append ".=:,(+-*/^<>" nil))))))))
    found))

(defconst mech-mode-font-lock-keywords
  (let ((name "[[:alpha:]_][[:alnum:]_]*")
        (not-member "\\(?:^\\|[^.[:alnum:]_]\\)"))
    `(("\\_<analysis[ \t]+\\(from\\)\\_>" 1 font-lock-keyword-face)
      (",[ \t]*\\(from\\|to\\)[ \t]+[^-+*/^=<>,) \t\n]" 1 font-lock-keyword-face)
      ("=[ \t]*\\(?:\\(periodic\\)[ \t]+\\)?\\(spline\\)[ \t]*[[\"]"
       (1 font-lock-keyword-face nil t) (2 font-lock-keyword-face))
      (,(concat not-member "\\(" (regexp-opt mech-mode-declarations) "\\)\\_>\\(?:[ \t]+\\(" name "\\)\\)?")
       (1 font-lock-keyword-face) (2 font-lock-variable-name-face nil t))
      (,(concat not-member "\\(" (regexp-opt mech-mode-openers) "\\)[ \t]+\\(" name "\\)[ \t]*[[=:]")
       (1 font-lock-keyword-face) (2 font-lock-variable-name-face))
      (,(concat not-member "\\(use\\)[ \t]*\"") 1 font-lock-keyword-face)
      (,(regexp-opt mech-mode-formula 'symbols) . font-lock-keyword-face)
      (mech-mode-find-place . font-lock-keyword-face)
      (,(concat ":[ \t]*\\(" (regexp-opt mech-mode-joints) "\\)[ \t]*(") 1 font-lock-type-face)
      (,(concat ",[ \t]*\\(" (regexp-opt mech-mode-sides) "\\)[ \t]*)") 1 font-lock-constant-face)
      (,(concat "\\_<\\(" (regexp-opt mech-mode-called) "\\)[ \t]*(") 1 font-lock-builtin-face)
      (,(concat not-member "\\(" (regexp-opt mech-mode-constants) "\\)\\_>") 1 font-lock-constant-face)
      (,(concat "\\(?:[0-9]\\|" not-member "\\)[ \t]*\\(" (regexp-opt mech-mode-units) "\\)\\_>") 1 font-lock-type-face)))
  "What gets which colour.")

(defvar mech-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?/ ". 12" table)
    (modify-syntax-entry ?\n ">" table)
    (modify-syntax-entry ?_ "_" table)
    (dolist (operator '(?+ ?- ?* ?^ ?< ?> ?=))
      (modify-syntax-entry operator "." table))
    table)
  "Comments, strings and brackets.")

(defun mech-mode-indent-line ()
  "Indent the line by the brackets around it."
  (interactive)
  (let* ((depth (save-excursion
                  (back-to-indentation)
                  (- (car (syntax-ppss)) (if (looking-at "[])}]") 1 0))))
         (from-end (- (point-max) (point))))
    (indent-line-to (* 4 (max 0 depth)))
    (when (> (- (point-max) from-end) (point))
      (goto-char (- (point-max) from-end)))))

;;;###autoload
(define-derived-mode mech-mode prog-mode "mech"
  "Major mode for planar mechanisms."
  (setq-local comment-start "// "
              comment-end ""
              indent-tabs-mode nil
              tab-width 4
              indent-line-function #'mech-mode-indent-line
              font-lock-defaults '(mech-mode-font-lock-keywords)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.mech\\'" . mech-mode))

(defvar eglot-server-programs)
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs '(mech-mode . ("mechc" "lsp"))))

(provide 'mech-mode)
;;; mech-mode.el ends here
